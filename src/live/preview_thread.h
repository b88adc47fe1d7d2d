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
#include "gl/timer.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace livery {

struct PreviewDescription {
    std::uint64_t number = 0;
    Scene scene;
    /// Shown right of `wipe_at`, a fraction of the view's width, in the light of `scene`.
    std::optional<Scene> wipe_to;
    double wipe_at = 0.5;
    View view;
    std::optional<View> projector;        ///< glints are shown as its pixels hold them
    std::optional<int> highlighted_part;  ///< outlined, on the part itself
    bool ground = true;                   ///< the product darkens the ground that it stands on
};

/// An sRGB picture in the share group.
struct PreviewPicture {
    std::uint64_t number = 0;
    unsigned texture = 0;  ///< RGBA8, sRGB-encoded, row 0 on top, straight alpha; 0: none yet
    glm::ivec2 size_px{0};
    std::shared_ptr<const Fence> ready;
    double ms = 0.0;
    int supersampling = 1;    ///< samples a pixel are its square
    bool unfinished = false;  ///< another follows when the scene's light, or ground, is solved
    std::string problem;      ///< why it could not be drawn; the last good picture stays
    std::shared_ptr<const void> owner;
};

/// Descriptions that come fast (orbiting) are drawn with one sample a pixel and refined when they
/// pause; a change of light or environment is drawn at once in the light that is there, and again
/// when the new one is solved. So one description may give several pictures with its number.
/// Pictures are valid until the thread is destroyed.
class PreviewThread {
  public:
    /// A context of the share group, current nowhere; it must outlive this. `on_finished` is called
    /// on the preview's thread and must not throw.
    PreviewThread(GlContext& context,
                  std::function<void(std::shared_ptr<const PreviewPicture>)> on_finished);
    ~PreviewThread();
    PreviewThread(const PreviewThread&) = delete;
    PreviewThread& operator=(const PreviewThread&) = delete;

    void show(PreviewDescription description);  ///< any thread; the newest wins

    /// A paint on a sphere in the studio's light, square, sRGB with coverage in a straight alpha;
    /// drawn when nothing more urgent is asked for, the last requested first, and kept in the
    /// user's folder by the paint's parameters. `on_drawn` is called on the preview's thread; an
    /// empty picture when it cannot be drawn (the log says why). Throws std::invalid_argument for a
    /// size beyond 8 to 1024.
    void request_swatch(const Material& material,
                        int size_px,
                        std::function<void(const Image8& rgba)> on_drawn);

    /// A small picture of a look, in the light that the preview has, whatever the look's own is: so
    /// that a row of them differs by paint alone. Drawn when nothing more urgent is asked for and
    /// once show() has given the preview its light; otherwise as request_swatch().
    void request_thumbnail(const Scene& scene,
                           const View& view,
                           std::function<void(const Image8& rgba)> on_drawn);

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// A point of the product that a pixel of a view shows.
struct PickedPoint {
    int part = 0;
    glm::dvec3 position_mm{0.0};
    glm::dvec3 normal{0.0, 1.0, 0.0};  ///< unit, on the side that is seen
};

/// What of the product a pixel of a view shows; nothing beside it. Any thread.
class PartPicker {
  public:
    explicit PartPicker(std::shared_ptr<const Product> product);
    ~PartPicker();
    PartPicker(const PartPicker&) = delete;
    PartPicker& operator=(const PartPicker&) = delete;
    std::optional<int> part_at(const View& view, const glm::dvec2& pixel) const;
    std::optional<PickedPoint> point_at(const View& view, const glm::dvec2& pixel) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace livery
