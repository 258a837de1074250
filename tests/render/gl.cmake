# Tests of the renderer on a headless GL context.
add_library(toile_test_shapes STATIC shapes.c)
target_link_libraries(toile_test_shapes PUBLIC toile_render PkgConfig::CMOCKA)
target_include_directories(toile_test_shapes PRIVATE ${CMAKE_SOURCE_DIR}/tests PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(toile_test_shapes PRIVATE TOILE_DATA_DIR="") # testing.h wants it; no shape reads data

toile_test(gpu gpu toile_render PkgConfig::EPOXY)
toile_test(light gpu toile_test_shapes)
toile_test(maps gpu toile_test_shapes)
toile_test(methods gpu toile_test_shapes)
toile_test(slice_maps gpu toile_render PkgConfig::EPOXY)
toile_test(renderer gpu toile_test_shapes)
toile_test(points truth toile_test_shapes)
toile_test(sequence gpu toile_test_shapes)
toile_test(layered truth toile_test_shapes)
toile_test(mirrors truth toile_test_shapes)
toile_test(golden golden toile_test_shapes)
toile_test(spots gpu toile_test_shapes PkgConfig::EPOXY)
toile_test(reference truth toile_test_shapes)
