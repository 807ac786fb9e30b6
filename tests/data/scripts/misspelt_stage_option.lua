-- expect unknown_option misspelt_stage_option.lua:2: volume_mesh: unknown key "tetrahedra.radius_egde", did you mean "radius_edge"?
volume_mesh{ read_surface "box.stl", first_height = 1e-3, tetrahedra = { radius_egde = 1.3 } }
