-- expect script_failed error_of_user.lua:2: the chord must be positive
local function check(c) if c <= 0 then error("the chord must be positive") end end
check(-1)
-- expect called from, innermost first:
