-- expect bad_argument module_outside.lua:2: require "../box": modules must be beside the script
require "../box"
