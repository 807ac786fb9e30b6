-- expect script_failed error_in_callback.lua:2: attempt to
box{ {0, 0, 0}, {1, 1, 1} }:deform{ function(x, y, z) return 0, 0, x.y end }
