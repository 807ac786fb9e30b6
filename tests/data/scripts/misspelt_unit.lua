-- expect script_failed misspelt_unit.lua:2: unknown name (global 'inches')
read_surface{ "box.stl", unit = inches }
-- expect did you mean inch?
