// Loaded ahead of the C library (LD_PRELOAD), writes a line "call path" to the file
// $LIVERY_PATH_CALLS for every call that opens, lists or asks after a path with $LIVERY_PATH_PART
// in it: so a test knows what a program does with files while it runs, stat() included, which no
// watch on a folder tells. No header of those calls is included: some of them define their names
// away.
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

constexpr int kAtCwd = -100,
              kAppend = 02001 | 0100 | 02000000;  // O_WRONLY, O_APPEND, O_CREAT, O_CLOEXEC

/// The name's next definition: the C library's.
template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void note(const char* call, const char* path) {
    static const char* const part = std::getenv("LIVERY_PATH_PART");
    static const char* const log = std::getenv("LIVERY_PATH_CALLS");
    if (!path || !part || !log || !std::strstr(path, part)) return;
    const long file = syscall(SYS_openat, kAtCwd, log, kAppend, 0600);
    const std::string line = std::string(call) + " " + path + "\n";
    syscall(SYS_write, file, line.data(), line.size());
    syscall(SYS_close, file);
}

unsigned mode_after(int flags, va_list arguments) {
    return (flags & 0100) != 0 ? va_arg(arguments, unsigned) : 0u;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_after(flags, more);
    va_end(more);
    note("open", path);
    return next<int(const char*, int, ...)>("open")(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_after(flags, more);
    va_end(more);
    note("open", path);
    return next<int(const char*, int, ...)>("open64")(path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_after(flags, more);
    va_end(more);
    note("openat", path);
    return next<int(int, const char*, int, ...)>("openat")(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const unsigned mode = mode_after(flags, more);
    va_end(more);
    note("openat", path);
    return next<int(int, const char*, int, ...)>("openat64")(folder, path, flags, mode);
}
FILE* fopen(const char* path, const char* mode) {
    note("fopen", path);
    return next<FILE*(const char*, const char*)>("fopen")(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
    note("fopen", path);
    return next<FILE*(const char*, const char*)>("fopen64")(path, mode);
}
void* opendir(const char* path) {
    note("opendir", path);
    return next<void*(const char*)>("opendir")(path);
}
int stat(const char* path, void* found) {
    note("stat", path);
    return next<int(const char*, void*)>("stat")(path, found);
}
int stat64(const char* path, void* found) {
    note("stat", path);
    return next<int(const char*, void*)>("stat64")(path, found);
}
int lstat(const char* path, void* found) {
    note("lstat", path);
    return next<int(const char*, void*)>("lstat")(path, found);
}
int lstat64(const char* path, void* found) {
    note("lstat", path);
    return next<int(const char*, void*)>("lstat64")(path, found);
}
int fstatat(int folder, const char* path, void* found, int flags) {
    note("fstatat", path);
    return next<int(int, const char*, void*, int)>("fstatat")(folder, path, found, flags);
}
int fstatat64(int folder, const char* path, void* found, int flags) {
    note("fstatat", path);
    return next<int(int, const char*, void*, int)>("fstatat64")(folder, path, found, flags);
}
int statx(int folder, const char* path, int flags, unsigned mask, void* found) {
    note("statx", path);
    using Function = int(int, const char*, int, unsigned, void*);
    return next<Function>("statx")(folder, path, flags, mask, found);
}
int access(const char* path, int mode) {
    note("access", path);
    return next<int(const char*, int)>("access")(path, mode);
}
int faccessat(int folder, const char* path, int mode, int flags) {
    note("faccessat", path);
    return next<int(int, const char*, int, int)>("faccessat")(folder, path, mode, flags);
}
ssize_t readlink(const char* path, char* target, std::size_t size) {
    note("readlink", path);
    return next<ssize_t(const char*, char*, std::size_t)>("readlink")(path, target, size);
}
char* realpath(const char* path, char* whole) {
    note("realpath", path);
    return next<char*(const char*, char*)>("realpath")(path, whole);
}

}  // extern "C"
