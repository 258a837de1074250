# The review window: its camera's moves, and the real window under a virtual display.
toile_test(orbit unit toile_app)
toile_test(history unit toile_app)
toile_test(frame_times unit toile_app)
toile_test(state unit toile_app)
add_test(NAME view_drive COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/view_drive.sh)
set_tests_properties(view_drive PROPERTIES LABELS cli TIMEOUT 900 SKIP_RETURN_CODE 77
  ENVIRONMENT "TOILE=$<TARGET_FILE:toile>")
