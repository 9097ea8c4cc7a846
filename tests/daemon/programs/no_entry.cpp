/// A shared library that is no program.
extern "C" __attribute__((visibility("default"))) int somethingElse() {
    return 42;
}
