-- expect bad_argument steps_out_of_order.lua:3: envelope.retract: entry 1: expected an envelope that is unwarped at least; this envelope is classified only
local wall = surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.5 }
envelope.retract{ envelope.classify{ wall } }
