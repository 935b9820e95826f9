// What programs of this folder check with.
#ifndef LAWS_HPP
#define LAWS_HPP

#include <cstdio>
#include <cstdlib>

#include <Eigen/Core>

/// Ends the program unless an error is at most `allowed`.
inline void expect(const char *law, double error, double allowed) {
    if (!(error <= allowed)) {
        std::printf("%s: found an error of %.3e, expected at most %.1e\n", law, error, allowed);
        std::exit(1);
    }
}

/// `Size` numbers within -1 and 1, by a generator that is the same everywhere.
template <int Size>
Eigen::Matrix<double, Size, 1> draw(unsigned &seed) {
    Eigen::Matrix<double, Size, 1> numbers;
    for (int k = 0; k < Size; k++) {
        seed = seed * 1664525u + 1013904223u;
        numbers[k] = static_cast<double>(seed >> 8) / (1 << 23) - 1.0;
    }
    return numbers;
}

#endif
