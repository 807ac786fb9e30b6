-- expect script_failed unclosed_table.lua:4: 
volume_mesh{ read_surface "box.stl",
  layers = 3
