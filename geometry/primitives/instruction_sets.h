#pragma once

/// Put before a function whose loops are to become vector code: one compiled copy per instruction
/// set, chosen when the program starts. Clang has no such levels yet, and runs the portable copy;
/// so does ThreadSanitizer, which is not there yet when GCC's instrumented choice runs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define ROADBED_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define ROADBED_CLONES
#endif
