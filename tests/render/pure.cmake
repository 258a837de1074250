# The parts of render that need no device.
foreach(name cube)
  toile_test(${name} unit toile_light)
endforeach()
