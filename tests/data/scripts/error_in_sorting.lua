-- expect bad_argument error_in_sorting.lua:3: volume_mesh: 2 problems in this table
-- A C function of Lua (sort) calls a verb. The script catches the error and raises it again.
local ok, problem = pcall(table.sort, {1, 2, 3}, function(a, b) return volume_mesh{} end)
assert(not ok and problem.code == "bad_argument" and tostring(problem):find("first_height", 1, true))
error(problem)
