-- expect bad_argument too_many_entries.lua:3: make_envelope: entry 2: there is one too many
local wall = read_surface "box.stl"
make_envelope{ wall, wall, first_height = 1e-3 }
