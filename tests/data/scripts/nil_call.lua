-- expect script_failed nil_call.lua:3: attempt to call a nil value (local 'frames_of')
local frames_of
fuselage{ frames = frames_of(3) }
