# toile view: the window, its panel (the only C++ of this floor) and the camera's moves.
target_sources(toile_app PRIVATE
  cmd_view.c
  frame_times.c
  history.c
  loader.c
  orbit.c
  panel_overlay_shim.cpp
  panel_rows_shim.cpp
  panel_shim.cpp
  panel_text_shim.cpp
  review_act.c
  review_draw.c
  review_edit.c
  review_keep.c
  review_keys.c
  review_load.c
  review_memory.c
  review_move.c
  review_panel.c
  review_pointer.c
  review_read.c
  review_wipe.c
  saved_views.c
  state.c
  watch.c
  window.c)
target_link_libraries(toile_app PRIVATE PkgConfig::GLFW PkgConfig::IMGUI PkgConfig::EPOXY)
