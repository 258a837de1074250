# Writes OUT with the macro NAME, a hash of the files that are listed in LIST, one a line, and of FLAGS.
# cmake -DNAME=... -DLIST=... -DFLAGS=... -DOUT=... -P write_version.cmake
file(STRINGS ${LIST} sources)
set(text "${FLAGS}")
foreach(source IN LISTS sources)
  file(SHA256 ${source} hash)
  string(APPEND text "${hash}")
endforeach()
string(SHA256 version "${text}")
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define ${NAME} \"${version}\"\n")
