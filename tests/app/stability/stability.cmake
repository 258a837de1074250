# The extremes, which tests share; and toile-stability, which runs them all and which `toile stability` executes. It is found
# beside the program, or in libexec where both are installed.
add_library(toile_extremes STATIC stability/outcome.c stability/envelope.c stability/extremes_cloth.c
  stability/extremes_light.c)
target_link_libraries(toile_extremes PUBLIC toile_lab PkgConfig::CJSON)
add_executable(toile-stability stability/stability.c stability/stability_cloth.c stability/stability_detail.c
  stability/stability_light.c stability/stability_shading.c)
target_link_libraries(toile-stability PRIVATE toile_extremes)
set_target_properties(toile-stability PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/app)
install(TARGETS toile-stability RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/toile)
toile_test(stability/extremes stability toile_extremes)
