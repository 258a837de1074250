# The parts of render that need no device.
foreach(name map_fit sky layout convert cube regions chain lobe plan flip compare trace ground lobes terms compose regions_sphere slices sun emitters lobe_error memory fan brdf)
  toile_test(${name} unit toile_light)
endforeach()
