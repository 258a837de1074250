# toile_embed(TARGET SYMBOL FILE...): compiles files into TARGET as `const struct tl_embedded SYMBOL[]`, ended by
# an entry whose name is NULL, and their names without folder and extension as `const char *const SYMBOL_names[]`.
# Rebuilt when a file changes.
function(toile_embed target symbol)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.c)
  set(inputs)
  foreach(file ${ARGN})
    list(APPEND inputs ${CMAKE_CURRENT_SOURCE_DIR}/${file})
  endforeach()
  add_custom_command(OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -D OUT=${out} -D SYMBOL=${symbol} -D "INPUTS=${inputs}" -P ${CMAKE_SOURCE_DIR}/config/embed_files.cmake
    DEPENDS ${inputs} ${CMAKE_SOURCE_DIR}/config/embed_files.cmake VERBATIM)
  target_sources(${target} PRIVATE ${out})
endfunction()
