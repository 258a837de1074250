# toile view: the window, its panel (the only C++ of this floor) and the camera's moves.
target_sources(toile_app PRIVATE
  cmd_view.c
  orbit.c
  panel_rows_shim.cpp
  panel_shim.cpp
  review_act.c
  review_input.c
  review_panel.c
  window.c)
target_link_libraries(toile_app PRIVATE PkgConfig::GLFW PkgConfig::IMGUI PkgConfig::EPOXY)
