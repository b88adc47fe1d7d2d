// The panel of lights, environment, eye, exposure and quality: what it remembers between frames,
// and its sections.
#pragma once

#include "live/frame_pictures.h"
#include "live/reference_thread.h"
#include "scene/look.h"
#include "scene/product.h"
#include "studio/studio.h"

namespace livery {

struct LightingPanelState {
    Held<Look> held;  ///< lights and environment
    Held<glm::dvec3> held_eye_mm;
    Held<double> held_ev;
    int lit_look = -1;  ///< whose lights are held
    std::shared_ptr<const Product> centre_of;
    glm::dvec3 centre_mm{0.0};  ///< of that product
    std::string observer_of;    ///< the bench
    std::optional<glm::dvec3> observer_mm;
    std::string thumbnail_of;
    Texture2D thumbnail;
    std::string thumbnail_problem;
    std::vector<std::string> shipped_environments;
    bool listed = false;
    double budget_s = 0.0;       ///< 0: not moved yet
    std::string budget_problem;  ///< why no levels fit it
};

struct ReferenceTracing {
    std::unique_ptr<ReferenceThread> thread;  ///< none: nobody asked yet
    std::uint64_t asked = 0;                  ///< the frame that is traced
    std::shared_ptr<const TracedFrame> taken;
    std::unique_ptr<TexturePool> textures;  ///< of the window's context
};

/// Why it cannot be traced now, in a sentence; empty: it can.
std::string why_not_traced(const Studio& studio);
/// Of the frame on the mock-up. Throws Refused when it cannot be.
void trace_reference_of(Studio& studio);
bool is_tracing(const Studio& studio);

/// A new picture to the projector, once a frame of the window; ended where something else is to be
/// shown.
void take_traced(Studio& studio);

void draw_reference_row(Studio& studio);

/// Edits `environment` (the held one of the look shown); commits and tries by itself.
void draw_environment_choice(Studio& studio,
                             EnvironmentReference& environment,
                             const std::function<void()>& after_item);

void draw_quality_section(Studio& studio);

}  // namespace livery
