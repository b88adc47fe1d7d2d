// Diffuse reflectance profiles R_d(r) of translucent media: how far from where light enters it
// leaves again, by the models of the field.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "appearance/subsurface/exact_totals.h"
#include "appearance/subsurface/scattering_stack.h"

namespace livery {

enum class SubsurfaceModel {
    dipole,                 ///< Jensen, Marschner, Levoy and Hanrahan 2001
    better_dipole,          ///< d'Eon 2012 with single scattering
    beam_diffusion,         ///< Habel, Christensen and Jarosz 2013 with single scattering
    scaled_beam_diffusion,  ///< the same, scaled to the exact total
    multipole,              ///< Donner and Jensen 2005
    p3,                     ///< third-order spherical harmonics, Hull and Foster 2001
    normalized_diffusion,   ///< Christensen and Burley 2015
};

struct SubsurfaceModelInfo {
    SubsurfaceModel model;
    const char* name;
    bool half_space, slab, layers;
    const char* summary;
};
const std::vector<SubsurfaceModelInfo>& subsurface_models();
const SubsurfaceModelInfo& info_of(SubsurfaceModel model);
/// Nothing for a name that no model has.
std::optional<SubsurfaceModel> find_subsurface_model(std::string_view name);

/// One model of one medium, with what does not depend on the radius worked out.
struct SubsurfaceProfile {
    SubsurfaceModel model = SubsurfaceModel::scaled_beam_diffusion;
    /// Of light that scattered, over the whole plane, per unit power that enters.
    DiffuseTotals totals;
    /// Some values of the model were below 0 and are given as 0: not a medium for it.
    bool was_negative = false;
    /// Below 1 where the model would create light: all of it is scaled down to what entered.
    double scale = 1.0;
    /// What the model says at r > 0, per mm^2 and unit power that enters, never below 0.
    std::function<double(double radius_mm)> reflected, transmitted;
    /// Both at once, for about the price of either.
    std::function<DiffuseTotals(double radius_mm)> both;
    double least_radius_mm = 0.0;

    /// The profile at r, and the mean over the disc of `least_radius_mm` within it. Finite. Throws
    /// std::invalid_argument for a negative radius or one that is no number.
    double reflectance(double radius_mm) const;
    double transmittance(double radius_mm) const;
    DiffuseTotals at(double radius_mm) const;
};

/// Throws std::invalid_argument (a medium out of range, a model that knows no slab or nothing but
/// slabs).
SubsurfaceProfile subsurface_profile(SubsurfaceModel model, const ScatteringMedium& medium);

/// The analytic model that is nearest to Monte Carlo in every medium and stack compared
/// (docs/subsurface.md).
inline constexpr SubsurfaceModel kBestSubsurfaceModel = SubsurfaceModel::scaled_beam_diffusion;
/// Within how much of the light it is so for media like this one.
std::string why_best(const ScatteringStack& stack);

/// The same for layers: scaled_beam_diffusion, with diffusion solved in all layers at once, or
/// multipole, layer by layer (Donner and Jensen 2005); others are refused as above. Layers of equal
/// coefficients are merged, and one that is left is the medium above.
SubsurfaceProfile subsurface_profile(SubsurfaceModel model, const ScatteringStack& stack);

/// Radius within which this share of what leaves the top does so, by the profile.
double energy_radius_mm(const SubsurfaceProfile& profile, double mean_free_path_mm, double share);
double energy_radius_mm(const SubsurfaceProfile& profile,
                        const ScatteringMedium& medium,
                        double share);

}  // namespace livery
