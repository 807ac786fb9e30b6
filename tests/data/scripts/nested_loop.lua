-- expect bad_argument nested_loop.lua:4: reading a table: tables are nested more than 16 deep
local t = {}
t.envelope = t
volume_mesh(t)
