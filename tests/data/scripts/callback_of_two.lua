-- expect script_failed a function must return 3 numbers here, but value 3 is nil
box{ {0, 0, 0}, {1, 1, 1} }:deform{ function(x, y, z) return 0, 0 end }
