// A look's fields as JSON, for look files and for whatever holds looks. Include only in *_io.cpp.
#pragma once

#include <vector>

#include "core/json.h"
#include "scene/look.h"

namespace livery {

/// The fields of a look file without its `format_version`; all may be missing, and the name is then
/// empty. Which others the object may have is the caller's to check. Throw FileError.
Look read_look(const JsonReader& object);
Json json_of(const Look& look);

std::vector<DirectionalLight> read_lights(const JsonReader& list);
Json json_of(const std::vector<DirectionalLight>& lights);

/// Throw FileError, for what check_artwork() refuses as well.
std::vector<Artwork> read_artwork(const JsonReader& list);
Json json_of(const std::vector<Artwork>& artwork);

/// The member `environment`; without it, no environment.
EnvironmentReference read_environment(const JsonReader& parent);
Json json_of(const EnvironmentReference& environment);

}  // namespace livery
