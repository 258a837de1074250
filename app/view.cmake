# toile view: the window, its panel (the only C++ of this floor) and the camera's moves.
target_sources(toile_app PRIVATE
  cmd_view.c
  orbit.c
  panel_rows_shim.cpp
  panel_shim.cpp
  view_act.c
  view_input.c
  view_panel.c
  window.c)
target_link_libraries(toile_app PRIVATE PkgConfig::GLFW PkgConfig::IMGUI PkgConfig::EPOXY)
