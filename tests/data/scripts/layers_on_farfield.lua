-- expect bad_argument layers_on_farfield.lua:2: setting the layers of patches: patches["farfield"] requests layers = 10, but its patches carry no layers: "farfield" (of kind farfield)
volume_mesh{ read_surface "box.stl", layers = 2, first_height = 1e-3, patches = { farfield = { layers = 10 } } }
-- expect add kind = "wall" to the rule
