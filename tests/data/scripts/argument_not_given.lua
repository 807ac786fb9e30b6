-- expect bad_argument argument_not_given.lua:2: args: argument alpha was not given
print(args.alpha)
