# The parts of render that need no device.
foreach(name
    detail/bake
    plan/budget
    pem/chain
    metrics/compare
    bounce/bounced
    bounce/bounce_sky
    light/compose
    light/kept_light
    plan/cost
    env/cube
    env/emitters
    plan/first_second
    brdf/fuzz
    brdf/matt
    brdf/ggx/ggx_lobes
    metrics/flip
    surfaces/ground
    env/layout
    inspect/legend
    env/mip_levels
    pem/lobe
    pem/lobe_error
    pem/paraboloids
    visibility/map_fit
    visibility/map_order
    frame/memory
    brdf/normalise
    plan/plan
    brdf/power
    pem/regions
    pem/regions_sphere
    detail/relief
    present/resample
    present/tone_map
    reference/sky
    pem/slices
    env/sun
    brdf/tables
    brdf/threads
    light/terms
    trace/trace
    )
  toile_test(${name} unit toile_light)
endforeach()
target_sources(test_ggx_lobes PRIVATE ./brdf/ggx/ggx_fitter.c)
foreach(name brdf/brdf env/convert brdf/factor brdf/lobe_fit brdf/measured_lobes env/lobes)
  toile_test(${name} slow toile_light)
endforeach()
