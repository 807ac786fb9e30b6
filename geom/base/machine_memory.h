// Available and used memory. For forecasts and reports only; results never depend on these values.
#pragma once

namespace sterna {

/// Returns the bytes that this process may still allocate: the minimum of the kernel's estimate of free memory, the rest of the address space limit (ulimit
/// -v), and the rest of the limit of the control group (containers, Slurm jobs). Infinite if no limit is reported.
double available_memory();
/// Returns the bytes of memory that this process uses now (resident set); 0 if not reported.
double resident_memory();

}  // namespace sterna
