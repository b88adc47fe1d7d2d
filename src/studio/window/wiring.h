// Session and stage in, results out: what runs between the window and the threads behind it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gl/window.h"
#include "scene/scene.h"
#include "session/document.h"

namespace livery {

struct Shell;
enum class ShadingDevice;

/// The contexts of the threads, one share group with the window's: they outlive the threads.
using Contexts = std::vector<std::unique_ptr<Window>>;

/// Starts the threads; the session, the product and the window's context are there, current.
Contexts start_threads(Shell& shell, const Window& window, ShadingDevice shading);
/// In the order in which one needs the other; with the window's context current.
void stop_threads(Shell& shell);

/// While the program opens without a projector: the window's picture is drawn before the mock-up's
/// light is solved, where one processor does both.
bool preview_goes_first(const Shell& shell);

/// A picture for the mock-up was asked for and has not reached the projector, if one shows.
bool is_frame_under_way(const Shell& shell);

/// At the start of each frame of the window: takes over what is new.
void take_results(Shell& shell);
/// Asks for a look of the document as it is, whatever is being tried or compared: its frame's
/// number. Nothing while files that its paints need are being read: ask again. Throws what makes it
/// impossible to draw.
std::optional<std::uint64_t> ask_for_look(Shell& shell, int look);
/// What to draw for a look of the document; shares environments that were read. Throws FileError.
Scene scene_for(Shell& shell, const Document& document, int look);
/// At its end: asks for what the changes call for. True when something was asked for.
void ask_for_changes(Shell& shell);

}  // namespace livery
