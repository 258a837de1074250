# What the system may refuse: see test_inject.c. Sanitizers have allocating functions of their own.
if(NOT TOILE_SANITIZE)
  add_library(inject_interpose MODULE inject/interpose.c inject/interpose_gl.c)
  target_link_libraries(inject_interpose PRIVATE toile_flags PkgConfig::EPOXY)
  set_target_properties(inject_interpose PROPERTIES C_VISIBILITY_PRESET default)
  add_executable(test_inject inject/test_inject.c inject/supervise.c inject/folder.c)
  target_link_libraries(test_inject PRIVATE toile_config PkgConfig::CJSON)
  add_test(NAME inject COMMAND test_inject $<TARGET_FILE:toile> $<TARGET_FILE:inject_interpose>)
  set_tests_properties(inject PROPERTIES LABELS inject TIMEOUT ${toile_script_timeout} SKIP_RETURN_CODE 77
    ENVIRONMENT "${toile_small_environment}")
  toile_place(inject app/inject test_inject inject_interpose toile)
endif()
