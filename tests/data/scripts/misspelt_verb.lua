-- expect script_failed misspelt_verb.lua:2: unknown name (global 'read_surfaces')
read_surfaces "box.stl"
-- expect did you mean read_surface?
