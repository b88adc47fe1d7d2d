// For the tests' desktop only. Xorg with the dummy driver, on a display number that was free.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "core/image.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

struct _XDisplay;

namespace livery {

class XServer {
  public:
    /// `largest_px`: what all monitors together may take. Throws std::runtime_error with the
    /// server's own words when it does not come up.
    explicit XServer(glm::ivec2 largest_px);

    const std::string& display() const { return display_; }  ///< ":5"
    pid_t process() const { return server_->id(); }
    /// The end of its log.
    std::string words() const;

  private:
    TemporaryFolder folder_;
    std::unique_ptr<ChildProcess> server_;
    std::string display_;
};

/// A client of the server: one thread's. What the server refuses it (a window that has gone in
/// the meantime) is a result for the caller and does not end the process, as it does by default.
class XClient {
  public:
    /// Throws std::runtime_error.
    explicit XClient(const std::string& display);
    ~XClient();
    XClient(const XClient&) = delete;
    XClient& operator=(const XClient&) = delete;

    _XDisplay* display() const { return display_; }
    /// A piece of the screen, 3 channels; nothing when it is not all on the screen.
    std::optional<Image8> read(int x, int y, int width, int height) const;

  private:
    _XDisplay* display_ = nullptr;
};

}  // namespace livery
