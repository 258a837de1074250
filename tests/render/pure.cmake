# The parts of render that need no device.
foreach(name cube regions regions_sphere sun chain lobe plan flip compare trace ground)
  toile_test(${name} unit toile_light)
endforeach()
