-- expect bad_argument help_on_nothing.lua:2: help: there is no verb, object or option "first_hieght", did you mean "first_height"?
help "first_hieght"
