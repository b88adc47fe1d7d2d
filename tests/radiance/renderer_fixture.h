// A renderer in OpenGL or on the processor.
#pragma once

#include <cmath>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "gl/context.h"
#include "radiance/renderer.h"
#include "radiance/scenes.h"
#include "support/direct_levels.h"
#include "support/gl_device.h"

namespace livery {

/// Everything holds in OpenGL and on the processor.
class Renderer : public ::testing::TestWithParam<ShadingDevice> {
  protected:
    HeadlessContext context{tested_gl()};

    /// Direct light alone, as the oracles have it.
    static FramePlan plan(const Scene& scene, Quality quality = Quality::normal) {
        if (quality == Quality::reference) {
            return plan_frame(scene, quality, FrameStage::radiance);
        }
        return plan_frame(scene, direct_levels(quality), FrameStage::radiance);
    }
    static ImageF draw(const Scene& scene, const View& view, Quality quality = Quality::normal) {
        return draw(scene, view, quality, GetParam());
    }
    static ImageF draw(const Scene& scene,
                       const View& view,
                       Quality quality,
                       ShadingDevice device) {
        RadianceRenderer renderer = renderer_of(scene, view, device);
        FramePlan its_plan = plan(scene, quality);
        renderer.render(scene, its_plan);
        return renderer.read_back();
    }
    static RadianceRenderer renderer_of(const Scene& scene,
                                        const View& view,
                                        ShadingDevice device = GetParam()) {
        return RadianceRenderer(
            std::make_shared<const FrameGeometry>(scene.product, view), false, device);
    }
    static bool in_opengl() { return GetParam() == ShadingDevice::gl; }
};

inline std::shared_ptr<const Environment> studio() {
    // Dim room, a soft box, a window and a lamp
    Environment environment;
    environment.radiance_working = ImageF(256, 128, 3);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 256; ++x) {
            const glm::dvec3 d = direction_from_uv(environment, {(x + 0.5) / 256, (y + 0.5) / 128});
            const auto lamp = [&](glm::dvec3 at, double width, double power) {
                const glm::dvec3 away = d - glm::normalize(at);
                return power * std::exp(-std::pow(glm::dot(away, away) / (width * width), 2.0));
            };
            const double value = 0.3 + 0.2 * d.y + lamp({0.3, 1, 0.2}, 0.5, 2.0) +
                                 lamp({1, 0.3, 0.6}, 0.3, 1.5) + lamp({-0.6, 0.5, 1}, 0.1, 8.0);
            float* pixel = environment.radiance_working.pixel(x, y);
            for (int c = 0; c < 3; ++c) {
                pixel[c] = static_cast<float>(value * (1.0 - 0.15 * c * (d.x > 0 ? 1 : 0)));
            }
        }
    }
    environment.rotation_rad = 0.7;
    environment.scale = 0.9;
    return std::make_shared<const Environment>(environment);
}

}  // namespace livery
