-- expect open_surface open_surface.lua:2: 
read_surface "open.off"
