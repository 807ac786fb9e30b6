-- expect script_failed forbidden_gc.lua:2: __gc is not available in scripts
setmetatable({}, { __gc = function() end })
