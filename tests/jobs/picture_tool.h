// A program that draws one file, which its argument names.
#pragma once

#include <cstdio>
#include <exception>

namespace livery {

/// `draw(file)` gives the exit code; 2 without a file, 1 where it throws.
template <typename Draw>
int draw_named_picture(int argc, char** argv, const Draw& draw) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: %s FILE.png\n", argv[0]);
        return 2;
    }
    try {
        return draw(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}

}  // namespace livery
