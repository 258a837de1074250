# `cmake --install`: program, C library, man pages, completion, desktop entry, documents; libexec has what `toile stability`
# executes (tests/app/stability). Presets, scenes, fabrics and shaders are compiled into the program, which reads no file of
# its own at run time; those installed are examples.
if(EXISTS /etc/debian_version AND CMAKE_LIBRARY_ARCHITECTURE)
  set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE} CACHE PATH "where libraries are looked for") # /usr/local's too
endif()
include(GNUInstallDirs)
set(here ${CMAKE_CURRENT_LIST_DIR})
set(toile_man ${CMAKE_BINARY_DIR}/man)

add_custom_command(OUTPUT ${toile_man}/toile.1 COMMAND sh ${here}/make_man.sh $<TARGET_FILE:toile> ${toile_man}
  DEPENDS toile ${here}/make_man.sh VERBATIM)
add_custom_target(toile_manual ALL DEPENDS ${toile_man}/toile.1)

# The prefix is found from the file's own place: an installed tree can be moved.
string(REGEX REPLACE "[^/]+" ".." toile_up "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
configure_file(${here}/toile.pc.in ${CMAKE_BINARY_DIR}/toile.pc @ONLY)

install(TARGETS toile RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS toile_library LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES app/library/toile.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${CMAKE_BINARY_DIR}/toile.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
install(DIRECTORY ${toile_man}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${here}/toile.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME toile)
install(FILES ${here}/_toile DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${here}/toile.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES ${here}/toile.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${here}/toile.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES ${here}/toile.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages)
install(FILES README.md README.png CHANGELOG.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY config/presets config/scenes config/fabrics DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)
install(FILES app/library/example.c app/library/example.py DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)
