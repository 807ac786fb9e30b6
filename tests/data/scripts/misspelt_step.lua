-- expect script_failed misspelt_step.lua:2: unknown name ('envelope.smoth')
envelope.smoth{}
-- expect did you mean envelope.smooth?
