# The review window: its camera's moves, and the real window under a virtual display; files are dropped on it by a
# small program of X11's, whose headers come with GL's.
toile_test(scene/orbit unit toile_app)
toile_test(view/loader unit toile_app)
toile_test(view/review_commands unit toile_app)
toile_test(view/history unit toile_app)
toile_test(view/frame_times unit toile_app)
toile_test(view/state unit toile_app)
find_package(X11 QUIET)
if(TARGET X11::X11)
  add_executable(drop_files view/drop_files.c)
  target_link_libraries(drop_files PRIVATE X11::X11)
  set(drop_files $<TARGET_FILE:drop_files>)
endif()
foreach(script IN ITEMS view_drive view_drop view_wipe)
  add_test(NAME ${script} COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/view/${script}.sh)
  set_tests_properties(${script} PROPERTIES LABELS cli TIMEOUT ${toile_script_timeout} SKIP_RETURN_CODE 77
    ENVIRONMENT "TOILE=$<TARGET_FILE:toile>;DROP=${drop_files};${toile_cache}")
endforeach()
