# The parts of render that need no device.
foreach(name cube regions regions_sphere sun chain emitters lobe lobe_error lobes slices memory plan flip compare trace ground terms compose)
  toile_test(${name} unit toile_light)
endforeach()
