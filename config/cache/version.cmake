# toile_version(TARGET HEADER NAME LIBRARIES SOURCE...): generates HEADER, which TARGET may include, with the macro NAME. A
# result that is kept (config/cache/cache.h) may be used again only by the code that would make the same one: the version is
# a hash of its sources, of the compiler and its flags, and of LIBRARIES, the libraries' versions.
set(toile_version_folder ${CMAKE_CURRENT_LIST_DIR})
function(toile_version target header name libraries)
  set(sources ${ARGN} ${CMAKE_SOURCE_DIR}/CMakeLists.txt) # the flags of every floor
  list(SORT sources)
  list(JOIN sources "\n" list)
  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/${name}.txt)
  file(WRITE ${list_file} "${list}\n")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build)
  get_directory_property(options COMPILE_OPTIONS)
  add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/${header}
    COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DLIST=${list_file}
      "-DFLAGS=${CMAKE_C_COMPILER_ID} ${CMAKE_C_COMPILER_VERSION} ${CMAKE_C_FLAGS} ${CMAKE_C_FLAGS_${build}} ${TOILE_HOT_FLAGS} ${options} ${CMAKE_SYSTEM_PROCESSOR} ${libraries}"
      -DOUT=${CMAKE_BINARY_DIR}/${header} -P ${toile_version_folder}/write_version.cmake
    DEPENDS ${sources} ${toile_version_folder}/write_version.cmake VERBATIM)
  target_sources(${target} PRIVATE ${CMAKE_BINARY_DIR}/${header})
endfunction()
