-- expect bad_argument text_for_number.lua:2: surface_mesh: max_edge: "10mm" is not allowed, expected a number
surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = "10mm" }
