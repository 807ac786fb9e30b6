-- expect script_failed forbidden.lua:2: unknown name (global 'io')
io.open("/etc/passwd")
