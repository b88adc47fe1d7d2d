// An OpenGL 4.5 core context, headless through EGL.
#pragma once

#include <memory>
#include <string>

namespace livery {

enum class GlDevice { automatic, software, hardware };

/// Makes a context current on the calling thread for its lifetime. Needs no display. Throws
/// std::runtime_error that names what was tried (and FileError-like text for the missing driver).
class HeadlessContext {
  public:
    explicit HeadlessContext(GlDevice device);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    std::string renderer() const;  ///< GL_RENDERER, e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
    bool is_software() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
