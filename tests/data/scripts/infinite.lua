-- expect bad_argument infinite.lua:2: surface_mesh: max_edge: inf is not allowed
surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = math.huge }
