// Formulas that can be put off by 2%, one at a time, so that tests/mutations.sh sees which test
// notices. Only a build with LIVERY_MUTATIONS has anything of it.
//   LIVERY_MUTATED(name, x)   x, a number, vector or matrix of floats or doubles
//   MUTATED(name, x)          the same in the source that GLSL and C++ share
#pragma once

#if defined(LIVERY_MUTATIONS)

#include <string>
#include <type_traits>

namespace livery {

/// 1.02 where the environment variable LIVERY_MUTATION is that name, else 1.
double mutation_factor(const char* name);

/// The text of a shader with MUTATED(name, x) times that factor.
std::string mutated_glsl(std::string text);

template <typename T>
T mutated_by(double factor, const T& x) {
    if constexpr (std::is_arithmetic_v<T>) {
        return static_cast<T>(static_cast<double>(x) * factor);
    } else {
        return x * static_cast<typename T::value_type>(factor);
    }
}

}  // namespace livery

// The environment is read once a place.
#define LIVERY_MUTATION_FACTOR(name)                                    \
    ([] {                                                               \
        static const double read_once = livery::mutation_factor(#name); \
        return read_once;                                               \
    }())
#define LIVERY_MUTATED(name, x) livery::mutated_by(LIVERY_MUTATION_FACTOR(name), x)
#define MUTATED(name, x) ((x)*R(LIVERY_MUTATION_FACTOR(name)))

#else

#define LIVERY_MUTATED(name, x) (x)
#define MUTATED(name, x) (x)

#endif
