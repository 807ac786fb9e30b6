-- expect script_failed needs more than 1024 MiB for its Lua values
local s = string.rep("x", 1.2e9)
