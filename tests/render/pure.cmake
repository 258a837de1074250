# The parts of render that need no device.
foreach(name cube regions chain lobe lobes plan flip compare)
  toile_test(${name} unit toile_light)
endforeach()
