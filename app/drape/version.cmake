# Writes OUT with TL_DRAPE_VERSION, a hash of all that is compiled into a drape: the files that are listed in LIST, one
# a line, and FLAGS. cmake -DLIST=... -DFLAGS=... -DOUT=... -P version.cmake
file(STRINGS ${LIST} sources)
set(text "${FLAGS}")
foreach(source IN LISTS sources)
  file(SHA256 ${source} hash)
  string(APPEND text "${hash}")
endforeach()
string(SHA256 version "${text}")
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define TL_DRAPE_VERSION \"${version}\"\n")
