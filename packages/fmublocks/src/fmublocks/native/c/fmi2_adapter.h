/* What the files of the adapter to FMI 2.0 share. */
#ifndef FMI2_ADAPTER_H
#define FMI2_ADAPTER_H

#include "fmi2Functions.h"
#include "instance.h"

#ifdef FMI2_FUNCTION_PREFIX /* some editions of the header leave it out of the names */
#undef fmi2FullName
#define JOINED(prefix, name) prefix##name
#define WITH_PREFIX(prefix, name) JOINED(prefix, name)
#define fmi2FullName(name) WITH_PREFIX(FMI2_FUNCTION_PREFIX, name)
#endif

static fmi2Status in_fmi(Status status);

#endif
