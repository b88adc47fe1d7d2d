// What the operator's window shows besides the projector's picture: the orbiting preview, the eye's
// view and the paint swatches, drawn on a thread of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "gl/context.h"
#include "gl/fence.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

struct PreviewDescription {
    std::uint64_t number = 0;
    Scene scene;
    View view;
    std::optional<int> highlighted_part;
};

/// An sRGB picture in the share group.
struct PreviewPicture {
    std::uint64_t number = 0;
    unsigned texture = 0;  ///< RGBA8, sRGB-encoded, row 0 on top, alpha: coverage
    glm::ivec2 size_px{0};
    std::shared_ptr<const Fence> ready;
    double ms = 0.0;
    std::string problem;
    std::shared_ptr<const void> owner;
};

class PreviewThread {
  public:
    PreviewThread(GlContext& context,
                  std::function<void(std::shared_ptr<const PreviewPicture>)> on_finished);
    ~PreviewThread();
    PreviewThread(const PreviewThread&) = delete;
    PreviewThread& operator=(const PreviewThread&) = delete;

    void show(PreviewDescription description);  ///< any thread; the newest wins

    /// A paint on a sphere in the studio's light, square, sRGB with coverage in alpha; drawn when
    /// nothing more urgent is asked for, kept in the user's folder by the paint's parameters.
    void request_swatch(const Material& material,
                        int size_px,
                        std::function<void(const Image8& rgba)> on_drawn);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// The part that a pixel of a view shows; nothing beside the product. Any thread.
class PartPicker {
  public:
    explicit PartPicker(std::shared_ptr<const Product> product);
    ~PartPicker();
    std::optional<int> part_at(const View& view, const glm::dvec2& pixel) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
