-- expect bad_argument point_of_two.lua:2: box: expected two points {x, y, z}
box{ {0, 0}, {1, 1, 1} }
