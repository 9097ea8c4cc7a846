/* Loaded in front of a program (LD_PRELOAD), this library stops it with exit code 99 and a backtrace as
 * soon as a thread that is inside the cycle allocates, locks, sleeps, throws or touches a file.
 * core::CycleGuard tells where the cycle is. Bus traffic (send, receive) and reading clocks are allowed.
 *
 * C, because the functions that are replaced here have other exception specifications in every C++
 * library. Memory goes to glibc's own entry points, so that nothing is looked up before it works. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

enum { HitExitCode = 99, MaxFrames = 48 };

/* Initial-exec: the flag lies in the thread's own block from the start; reading it never allocates. */
static __thread bool armed __attribute__((tls_model("initial-exec")));
static __thread bool mayThrow __attribute__((tls_model("initial-exec")));
static unsigned long armings;

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* block, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void* block);

void taktTrapArm(bool on);

void taktTrapArm(bool on) {
    armed = on;
    if (on) __atomic_add_fetch(&armings, 1, __ATOMIC_RELAXED);
}

/* Around the call of a user program: it may throw, and its exception needs memory until it is caught. */
void taktTrapMayThrow(bool on);

void taktTrapMayThrow(bool on) { mayThrow = on; }

static void say(const char* text) {
    if (syscall(SYS_write, STDERR_FILENO, text, strlen(text)) < 0) _exit(HitExitCode);
}

static void stop(const char* what) {
    void* frames[MaxFrames];
    armed = false;
    say("takt trap: ");
    say(what);
    say(" inside the cycle\n");
    backtrace_symbols_fd(frames, backtrace(frames, MaxFrames), STDERR_FILENO);
    _exit(HitExitCode);
}

static inline void check(const char* what) {
    if (__builtin_expect(armed, 0)) stop(what);
}

/* The function that the program would have called without this library. */
static void* next(void** slot, const char* name) {
    void* real = __atomic_load_n(slot, __ATOMIC_ACQUIRE);
    if (real != NULL) return real;
    /* glibc keeps an old, incompatible form of the condition variables under the plain name. */
    if (strncmp(name, "pthread_cond_", 13) == 0) real = dlvsym(RTLD_NEXT, name, "GLIBC_2.3.2");
    if (real == NULL) real = dlsym(RTLD_NEXT, name);
    if (real == NULL) {
        say("takt trap: there is no other ");
        say(name);
        say("\n");
        _exit(HitExitCode);
    }
    __atomic_store_n(slot, real, __ATOMIC_RELEASE);
    return real;
}

/* Defines `name` as: stop when armed, else do what it always did. */
#define TRAPPED(type, name, parameters, arguments)                \
    type name parameters {                                        \
        static void* slot;                                        \
        check(#name);                                             \
        return ((type(*) parameters)next(&slot, #name))arguments; \
    }

/* ---- memory ---- */

void* malloc(size_t size) {
    check("malloc");
    return __libc_malloc(size);
}

void* calloc(size_t count, size_t size) {
    check("calloc");
    return __libc_calloc(count, size);
}

void* realloc(void* block, size_t size) {
    check("realloc");
    return __libc_realloc(block, size);
}

void free(void* block) {
    if (block == NULL) return; /* does nothing, whoever calls it */
    check("free");
    __libc_free(block);
}

void* memalign(size_t alignment, size_t size) {
    check("memalign");
    return __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size) {
    check("aligned_alloc");
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, size_t alignment, size_t size) {
    check("posix_memalign");
    if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) {
        return EINVAL;
    }
    void* const got = __libc_memalign(alignment, size);
    if (got == NULL) return ENOMEM;
    *block = got;
    return 0;
}

TRAPPED(void*, mmap, (void* at, size_t size, int protection, int flags, int file, off_t offset),
        (at, size, protection, flags, file, offset))
TRAPPED(int, munmap, (void* at, size_t size), (at, size))

/* ---- waiting ---- */

TRAPPED(int, pthread_mutex_lock, (pthread_mutex_t * mutex), (mutex))
TRAPPED(int, pthread_mutex_timedlock, (pthread_mutex_t * mutex, const struct timespec* until),
        (mutex, until))
TRAPPED(int, pthread_rwlock_rdlock, (pthread_rwlock_t * lock), (lock))
TRAPPED(int, pthread_rwlock_wrlock, (pthread_rwlock_t * lock), (lock))
TRAPPED(int, pthread_cond_wait, (pthread_cond_t * condition, pthread_mutex_t* mutex),
        (condition, mutex))
TRAPPED(int, pthread_cond_timedwait,
        (pthread_cond_t * condition, pthread_mutex_t* mutex, const struct timespec* until),
        (condition, mutex, until))
TRAPPED(int, pthread_cond_clockwait,
        (pthread_cond_t * condition, pthread_mutex_t* mutex, clockid_t clock,
         const struct timespec* until),
        (condition, mutex, clock, until))
TRAPPED(int, pthread_join, (pthread_t thread, void** result), (thread, result))
TRAPPED(int, pthread_create,
        (pthread_t * thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument),
        (thread, attributes, run, argument))
TRAPPED(int, sem_wait, (sem_t * semaphore), (semaphore))
TRAPPED(int, sem_timedwait, (sem_t * semaphore, const struct timespec* until), (semaphore, until))
TRAPPED(int, nanosleep, (const struct timespec* wanted, struct timespec* left), (wanted, left))
TRAPPED(int, clock_nanosleep,
        (clockid_t clock, int flags, const struct timespec* wanted, struct timespec* left),
        (clock, flags, wanted, left))
TRAPPED(int, usleep, (useconds_t wanted), (wanted))
TRAPPED(unsigned int, sleep, (unsigned int wanted), (wanted))

/* std::atomic::wait and the semaphores of C++20 wait by this call. */
long syscall(long number, ...) {
    static void* slot;
    long a[6];
    va_list list;
    va_start(list, number);
    for (int i = 0; i < 6; ++i) a[i] = va_arg(list, long);
    va_end(list);
    if (number == SYS_futex) {
        const long operation = a[1] & FUTEX_CMD_MASK;
        if (operation == FUTEX_WAIT || operation == FUTEX_WAIT_BITSET || operation == FUTEX_LOCK_PI) {
            check("futex wait");
        }
    }
    return ((long (*)(long, ...))next(&slot, "syscall"))(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

/* ---- files and text ---- */

static mode_t modeOf(int flags, va_list list) {
    return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(list, mode_t) : 0;
}

#define TRAPPED_OPEN(name)                                                    \
    int name(const char* path, int flags, ...) {                              \
        static void* slot;                                                    \
        va_list list;                                                         \
        va_start(list, flags);                                                \
        const mode_t mode = modeOf(flags, list);                              \
        va_end(list);                                                         \
        check(#name);                                                         \
        return ((int (*)(const char*, int, ...))next(&slot, #name))(path, flags, mode); \
    }

#define TRAPPED_OPENAT(name)                                                  \
    int name(int folder, const char* path, int flags, ...) {                  \
        static void* slot;                                                    \
        va_list list;                                                         \
        va_start(list, flags);                                                \
        const mode_t mode = modeOf(flags, list);                              \
        va_end(list);                                                         \
        check(#name);                                                         \
        return ((int (*)(int, const char*, int, ...))next(&slot, #name))(folder, path, flags, mode); \
    }

TRAPPED_OPEN(open)
TRAPPED_OPEN(open64)
TRAPPED_OPENAT(openat)
TRAPPED_OPENAT(openat64)
TRAPPED(ssize_t, read, (int file, void* bytes, size_t size), (file, bytes, size))
TRAPPED(ssize_t, write, (int file, const void* bytes, size_t size), (file, bytes, size))
TRAPPED(ssize_t, pread, (int file, void* bytes, size_t size, off_t at), (file, bytes, size, at))
TRAPPED(ssize_t, pwrite, (int file, const void* bytes, size_t size, off_t at),
        (file, bytes, size, at))
TRAPPED(ssize_t, writev, (int file, const struct iovec* parts, int count), (file, parts, count))
TRAPPED(int, close, (int file), (file))
TRAPPED(int, fsync, (int file), (file))
TRAPPED(FILE*, fopen, (const char* path, const char* mode), (path, mode))
TRAPPED(FILE*, fopen64, (const char* path, const char* mode), (path, mode))
TRAPPED(int, fclose, (FILE * file), (file))
TRAPPED(int, fflush, (FILE * file), (file))
TRAPPED(size_t, fwrite, (const void* bytes, size_t size, size_t count, FILE* file),
        (bytes, size, count, file))
TRAPPED(size_t, fread, (void* bytes, size_t size, size_t count, FILE* file),
        (bytes, size, count, file))
TRAPPED(int, puts, (const char* text), (text))
TRAPPED(int, fputs, (const char* text, FILE* file), (text, file))
TRAPPED(int, putchar, (int character), (character))
TRAPPED(int, fputc, (int character, FILE* file), (character, file))
TRAPPED(int, vfprintf, (FILE * file, const char* format, va_list list), (file, format, list))

int vprintf(const char* format, va_list list) { return vfprintf(stdout, format, list); }

int printf(const char* format, ...) {
    va_list list;
    va_start(list, format);
    const int count = vfprintf(stdout, format, list);
    va_end(list);
    return count;
}

int fprintf(FILE* file, const char* format, ...) {
    va_list list;
    va_start(list, format);
    const int count = vfprintf(file, format, list);
    va_end(list);
    return count;
}

/* ---- what C++ and the loader do behind the scenes ---- */

TRAPPED(void*, dlopen, (const char* path, int flags), (path, flags))

void* __cxa_allocate_exception(size_t size);

void* __cxa_allocate_exception(size_t size) {
    static void* slot;
    if (mayThrow) armed = false; /* the catch path arms again */
    return ((void* (*)(size_t))next(&slot, "__cxa_allocate_exception"))(size);
}

void __cxa_throw(void* object, void* type, void (*destroy)(void*)) __attribute__((noreturn));

void __cxa_throw(void* object, void* type, void (*destroy)(void*)) {
    static void* slot;
    check("throw");
    ((void (*)(void*, void*, void (*)(void*)))next(&slot, "__cxa_throw"))(object, type, destroy);
    __builtin_unreachable();
}

/* Called only where a function-local static is not there yet: its first use must not be in the cycle. */
int __cxa_guard_acquire(long long* guard);
TRAPPED(int, __cxa_guard_acquire, (long long* guard), (guard))

/* ---- start and end ---- */

/* The first backtrace loads a library; that must have happened before it is wanted. */
__attribute__((constructor)) static void prime(void) {
    void* frames[2];
    (void)backtrace(frames, 2);
}

/* TAKT_TRAP_REPORT=FILE: a test can see that the trap was there and armed, not merely silent. */
__attribute__((destructor)) static void report(void) {
    const char* const path = getenv("TAKT_TRAP_REPORT");
    armed = false;
    if (path == NULL) return;
    FILE* const file = fopen(path, "a");
    if (file == NULL) return;
    fprintf(file, "armed %lu times, no hit\n", armings);
    fclose(file);
}
