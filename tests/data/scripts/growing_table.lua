-- expect script_failed needs more than 1024 MiB for its Lua values
local s = "x"
while true do s = s .. s end
