-- expect bad_argument misspelt_patch_rule.lua:2: volume_mesh: patches["wing*"]: unknown key "layer", did you mean "layers"?
volume_mesh{ read_surface "box.stl", first_height = 1e-3, patches = { ["wing*"] = { layer = 3 } } }
