-- expect bad_argument unready_envelope.lua:3: 
local wall = surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.5 }
tetrahedra{ envelope.classify{ wall } }
-- expect the envelope has no heights yet
