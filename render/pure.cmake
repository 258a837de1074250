# The parts of render that know neither GL nor the clock.
add_library(toile_light STATIC
  env/cube.c
  env/pour.c
  env/sun.c
  metrics/compare.c
  metrics/flip.c
  pem/chain.c
  pem/lobe.c
  pem/regions.c
  pem/regions_faces.c
  pem/regions_sphere.c
  plan/plan.c
  surfaces/ground.c
  trace/cutout.c
  trace/trace.c
)
target_link_libraries(toile_light PUBLIC toile_assets PRIVATE embree)
