-- expect bad_argument too_many_entries.lua:3: make_envelope: entry 2: unexpected
local wall = read_surface "box.stl"
make_envelope{ wall, wall, first_height = 1e-3 }
