# The parts of render that know neither GL nor the clock.
add_library(toile_light STATIC
  env/convert.c
  env/cube.c
  env/emitters.c
  env/layout.c
  env/lobes.c
  light/compose.c
  light/mirrors.c
  env/pour.c
  env/sun.c
  frame/view.c
  light/region_lights.c
  light/samples.c
  metrics/compare.c
  metrics/flip.c
  pem/chain.c
  pem/lobe.c
  pem/lobe_error.c
  pem/memory.c
  pem/regions.c
  pem/regions_faces.c
  pem/regions_sphere.c
  pem/slices.c
  plan/plan.c
  reference/gather.c
  reference/options.c
  reference/reference.c
  reference/sky.c
  reference/spot.c
  reference/texture.c
  surfaces/ground.c
  trace/cutout.c
  trace/trace.c
  visibility/fit.c
)
target_link_libraries(toile_light PUBLIC toile_assets PRIVATE embree)
