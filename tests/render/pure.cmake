# The parts of render that need no device.
foreach(name sky cube regions chain lobe plan flip compare trace ground lobes terms compose regions_sphere slices sun emitters)
  toile_test(${name} unit toile_light)
endforeach()
