// Checks without a framework: count failures, print the place and the numbers.
#pragma once

#include <cmath>
#include <cstdio>
#include <utility>

inline int failures = 0;

/// Whether `value` is within `tolerance` of `expected`; NaN never is.
inline void check_near(double value, double expected, double tolerance, const char* file, int line, const char* what) {
    if (std::abs(value - expected) <= tolerance) return;
    ++failures;
    std::printf("%s:%d: %s = %.17g, expected %.17g within %.1e\n", file, line, what, value, expected, tolerance);
}

inline void check_true(bool fact, const char* file, int line, const char* what) {
    if (fact) return;
    ++failures;
    std::printf("%s:%d: %s is false\n", file, line, what);
}

#define CHECK_NEAR(value, expected, tolerance) check_near(value, expected, tolerance, __FILE__, __LINE__, #value)
#define CHECK(fact) check_true(fact, __FILE__, __LINE__, #fact)

/// Whether a call throws an exception of the given kind.
template <class Error, class Call>
bool throws(Call&& call) {
    try {
        std::forward<Call>(call)();
    } catch (const Error&) {
        return true;
    }
    return false;
}

inline int report(const char* name) {
    std::printf("%s: %s (%d failures)\n", name, failures == 0 ? "passed" : "FAILED", failures);
    return failures == 0 ? 0 : 1;
}
