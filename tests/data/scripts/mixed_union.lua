-- expect bad_argument mixed_union.lua:2: union: entry 2: union takes models (exact geometry) or triangulated surfaces, not both; this is a surface
union{ box{ {0, 0, 0}, {1, 1, 1} }, read_surface "box.stl" }
