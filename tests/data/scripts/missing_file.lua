-- expect file_not_found missing_file.lua:2: 
read_surface{ "no_such_file.stl" }
