// Holds the precompiled headers of all tests; CMake wants a source for them.
