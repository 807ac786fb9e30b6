-- expect file_malformed malformed_file.lua:2: 
read_surface "malformed.off"
