-- expect bad_argument missing_argument.lua:2: args: argument alpha is missing: sterna run missing_argument.lua alpha=VALUE
local p = args{ "alpha", beta = 0 }
