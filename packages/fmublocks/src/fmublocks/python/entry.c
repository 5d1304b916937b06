/* The entry of an FMU of PythonFMU on Linux, between the host and PythonFMU's binary, which reads "file:///path" and
 * "/path" with no letter escaped that is not ASCII, and ends the process with anything else. Here every legal form of a
 * resource URI (RFC 8089) is read, what is none is refused with a message, and so are another guid or kind and a host in
 * which there is no Python. All other calls go on as they are. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* As they were before glibc 2.34, so that older systems load it too. */
__asm__(".symver dlopen, dlopen@GLIBC_2.2.5\n.symver dlsym, dlsym@GLIBC_2.2.5");
__asm__(".symver dladdr, dladdr@GLIBC_2.2.5\n.symver dlerror, dlerror@GLIBC_2.2.5");

#define EXPORT __attribute__((visibility("default")))

enum { ERROR = 3, CO_SIMULATION = 1, LONGEST = 8192 };

typedef struct {
    void (*log)(void *environment, const char *name, int status, const char *category, const char *message, ...);
    void *allocate, *release, *finished, *environment;
} Callbacks;

typedef void *Instantiate(const char *, int, const char *, const char *, const Callbacks *, int, int);

static void *binary;

/* Jumps to the function of that name in PythonFMU's binary, with all arguments where they are. */
#define FUNCTIONS(F)                                                                                                   \
    F(fmi2SetDebugLogging) F(fmi2FreeInstance) F(fmi2SetupExperiment) F(fmi2EnterInitializationMode)                   \
    F(fmi2ExitInitializationMode) F(fmi2Terminate) F(fmi2Reset) F(fmi2GetReal) F(fmi2GetInteger) F(fmi2GetBoolean)     \
    F(fmi2GetString) F(fmi2SetReal) F(fmi2SetInteger) F(fmi2SetBoolean) F(fmi2SetString) F(fmi2GetFMUstate)            \
    F(fmi2SetFMUstate) F(fmi2FreeFMUstate) F(fmi2SerializedFMUstateSize) F(fmi2SerializeFMUstate)                      \
    F(fmi2DeSerializeFMUstate) F(fmi2GetDirectionalDerivative) F(fmi2SetRealInputDerivatives)                          \
    F(fmi2GetRealOutputDerivatives) F(fmi2DoStep) F(fmi2CancelStep) F(fmi2GetStatus) F(fmi2GetRealStatus)              \
    F(fmi2GetIntegerStatus) F(fmi2GetBooleanStatus) F(fmi2GetStringStatus)

#define JUMP(name)                                                                                                     \
    __attribute__((used, visibility("hidden"))) void *entry_##name;                                                    \
    __asm__(".text\n.globl " #name "\n.type " #name ", @function\n" #name ":\n\tjmp *entry_" #name "(%rip)\n");
FUNCTIONS(JUMP)

EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

static int digit(char c)
{
    const char *const digits = "0123456789abcdef";
    const char *found = c ? strchr(digits, c | 0x20) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* The absolute path of a URI, or of a plain path; 0 if it is neither, or too long. */
static int path_of(const char *uri, char path[LONGEST])
{
    const int escaped = uri && strncasecmp(uri, "file:", 5) == 0;
    size_t n = 0;
    if (escaped) {
        uri += 5;
        if (strncmp(uri, "//", 2) == 0) {
            uri += strncasecmp(uri, "//localhost/", 12) == 0 ? 11 : 2;
        }
    }
    if (!uri || *uri != '/') {
        return 0;
    }
    for (; *uri; uri++) {
        if (n + 1 == LONGEST) {
            return 0;
        }
        path[n++] = *uri;
        if (escaped && *uri == '%') {
            const int high = digit(uri[1]), low = high < 0 ? -1 : digit(uri[2]);
            if (low < 0 || high + low == 0) {
                return 0;
            }
            path[n - 1] = (char)(16 * high + low);
            uri += 2;
        }
    }
    path[n] = '\0';
    return 1;
}

/* Whether a file has a text; so does one that is not there, if that is said. */
static int has_text(const char *folder, const char *file, const char *text, int absent)
{
    char name[2 * LONGEST], line[2 * LONGEST];
    int found = 0;
    snprintf(name, sizeof name, "%s/%s", folder, file);
    FILE *const opened = fopen(name, "r");
    if (!opened) {
        return absent;
    }
    while (!found && fgets(line, sizeof line, opened)) {
        found = strstr(line, text) != NULL;
    }
    fclose(opened);
    return found;
}

/* PythonFMU's binary, beside this one. */
static int load(void)
{
    char name[LONGEST];
    Dl_info own;
    if (binary) {
        return 1;
    }
    if (!dladdr(&binary, &own)) {
        return 0;
    }
    snprintf(name, sizeof name, "%.*s.python.so", (int)strlen(own.dli_fname) - 3, own.dli_fname);
    binary = dlopen(name, RTLD_NOW);
    return binary != NULL;
}

#define FIND(name) entry_##name = dlsym(binary, #name);

EXPORT void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                             const Callbacks *callbacks, int visible, int logging)
{
    char path[LONGEST], attribute[LONGEST];
    const char *what = NULL, *which = resources ? resources : "";
    snprintf(attribute, sizeof attribute, " guid=\"%.4096s\"", guid ? guid : "");
    if (!path_of(resources, path)) {
        what = "fmuResourceLocation = '%s' is no URI of a file on this machine";
    } else if (!has_text(path, "slavemodule.txt", "", 0)) {
        what = "fmuResourceLocation = '%s' is not the folder of the resources of this FMU";
    } else if (type != CO_SIMULATION) {
        what = "fmuType = %s: this FMU is for co-simulation alone";
        which = "fmi2ModelExchange";
    } else if (strchr(path, '%')) {
        what = "fmuResourceLocation = '%s': PythonFMU's binary cannot read a path with a percent sign in it";
    } else if (!guid || !*guid || !has_text(path, "../modelDescription.xml", attribute, 1)) {
        what = "fmuGUID = '%s' is not the guid of this FMU";
        which = guid ? guid : "";
    } else if (!load()) {
        what = "there is no Python of version 3.11 or later in this process: %s";
        which = dlerror();
    }
    if (what) {
        if (callbacks && callbacks->log) {
            callbacks->log(callbacks->environment, name, ERROR, "logStatusError", what, which);
        }
        return NULL;
    }
    FUNCTIONS(FIND)
    Instantiate *go_on;
    *(void **)&go_on = dlsym(binary, "fmi2Instantiate");
    return go_on(name, type, guid, path, callbacks, visible, logging);
}
