-- expect bad_argument in_a_function.lua:3: sphere: radius: -1 is not allowed
local function farthest()
  return sphere{ radius = -1 }
end
farthest()
