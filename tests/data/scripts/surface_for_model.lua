-- expect bad_argument surface_for_model.lua:2: surface_mesh: entry 1: expected a model (from read_cad, aircraft ...) or a component, not a surface, which has triangles already: pass it to volume_mesh
surface_mesh{ read_surface "box.stl" }
