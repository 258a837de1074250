# The parts of render that need no device.
foreach(name cube regions chain emitters lobe lobe_error lobes slices plan flip compare trace ground)
  toile_test(${name} unit toile_light)
endforeach()
