# The parts of render that need no device.
foreach(name cube regions chain lobe terms plan flip compare)
  toile_test(${name} unit toile_light)
endforeach()
