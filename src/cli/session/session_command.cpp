// livery session

#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/monitor_projector.h"
#include "cli/session/seat_report.h"
#include "core/error.h"
#include "jobs/export_product.h"
#include "jobs/render/render.h"
#include "live/projector_setup.h"
#include "scene/library.h"
#include "session/look_exchange.h"
#include "session/session.h"
#include "session/session_file.h"

namespace livery {

namespace {

using Path = std::filesystem::path;

/// What a script wants to know after a change, and before the next.
struct Summary {
    Document document;
    std::int64_t position = 0, last = 0;
    std::string undo_label, redo_label;
};

Summary read_summary(const Path& file) {
    SessionFile store(file, SessionFile::Access::read);
    Summary summary;
    summary.position = store.position();
    summary.last = store.last_step();
    summary.document = with_paints_read(store.document(summary.position));
    if (summary.position > 0) summary.undo_label = store.step(summary.position).label;
    if (summary.position < summary.last) {
        summary.redo_label = store.step(summary.position + 1).label;
    }
    return summary;
}

Json label_json(const std::string& label) { return label.empty() ? Json(nullptr) : Json(label); }

Outcome told(const Path& file, const Summary& summary) {
    const Document& document = summary.document;
    Outcome outcome;
    outcome.figures = {{"file", file.string()},
                       {"document", Json::parse(text_of(document))},
                       {"undo_steps", summary.position},
                       {"redo_steps", summary.last - summary.position},
                       {"undo", label_json(summary.undo_label)},
                       {"redo", label_json(summary.redo_label)}};
    outcome.text = fmt::format("{}: {}, exposure {:.4g} EV, quality {}, {}\n",
                               file.string(),
                               document.product,
                               document.exposure_ev,
                               to_string(document.quality),
                               document.calibration.empty() ? "uncorrected" : document.calibration);
    for (const SessionLook& look : document.looks) {
        outcome.text += fmt::format("look {:<3} {}\n", look.id, look.look.name);
        for (const auto& [part, paint] : look.look.parts) {
            outcome.text += fmt::format("           {:<10} {}\n", part, paint);
        }
    }
    for (const Material& paint : document.paints) {
        outcome.text += fmt::format("paint    {} ({})\n", paint.name, paint.provenance);
    }
    const auto steps = [](std::int64_t count, const std::string& label) {
        return label.empty() ? "none" : fmt::format("{}, next: {}", count, label);
    };
    outcome.text += fmt::format("undo     {}\nredo     {}\n",
                                steps(summary.position, summary.undo_label),
                                steps(summary.last - summary.position, summary.redo_label));
    tell_notes(drawing_problems(document), outcome);
    return outcome;
}

Session open_existing(const Path& file) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        throw FileError(file, "", "no such file", "a session (livery session new makes one)");
    }
    return Session::open(file);
}

/// Runs `change` on the session, tells of it, and fails when it could not be saved.
Outcome changed(const Path& file, const std::function<void(Session&)>& change) {
    {
        Session session = open_existing(file);
        change(session);
        if (const auto problem = session.save_problem()) throw std::runtime_error(*problem);
    }
    return told(file, read_summary(file));
}

/// All or none: a mistake in the third command leaves the first two undone as well.
void execute_all(Session& session, const std::vector<SessionCommand>& commands) {
    std::set<Path> files;
    for (const SessionCommand& command : commands) {
        files.merge(unread_files(session.document(), command));
    }
    session.use(read_paint_library(session.document().library, files));
    Document tried = session.document();
    for (const SessionCommand& command : commands) tried = applied(tried, command);
    for (const SessionCommand& command : commands) session.execute(command);
}

void step(Session& session, int steps, bool back) {
    const Document before = session.document();
    for (int k = 0; k < steps; ++k) {
        if (back ? session.can_undo() : session.can_redo()) {
            back ? session.undo() : session.redo();
            continue;
        }
        for (; k > 0; --k) back ? session.redo() : session.undo();
        throw Refused(
            fmt::format("the session has fewer than {} steps to {}", steps, back ? "undo" : "redo"),
            "livery session show says how many there are");
    }
}

struct SessionArguments {
    std::string file, product = "car", unit, out, look_file, stage = "radiance";
    std::vector<std::string> commands;
    std::string eye, looks, maps;  ///< of seats
    int steps = 1, look = 0, arc = 0;
};
using SharedArguments = std::shared_ptr<SessionArguments>;

Command session_command(const std::string& name,
                        const std::string& summary,
                        const std::string& example,
                        const SharedArguments& arguments,
                        std::vector<Option> options) {
    Command command;
    command.name = "session " + name;
    command.summary = summary;
    command.example = "livery session " + name + " " + example;
    command.options = {{"file", "FILE", "the session", &arguments->file, true}};
    for (Option& option : options) command.options.push_back(std::move(option));
    return command;
}

Command new_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command =
        session_command("new",
                        "begin a session with the shipped looks",
                        "show.livery --product car",
                        arguments,
                        {{"--product",
                          "FILE",
                          "a mesh or product file, or car, player, sphere (default car)",
                          &arguments->product},
                         unit_option(arguments->unit)});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        std::error_code error;
        if (std::filesystem::exists(arguments->file, error)) {
            throw Refused(arguments->file + " is there already",
                          "name another file, or remove that one");
        }
        const auto unit = parse_unit(arguments->unit);
        { const Session session = Session::open(arguments->file, arguments->product, unit); }
        Outcome outcome = told(arguments->file, read_summary(arguments->file));
        tell_notes(find_product(arguments->product, unit)->notes, outcome);
        return outcome;
    };
    return command;
}

Command show_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command = session_command("show", "what a session holds", "show.livery", arguments, {});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        return told(arguments->file, read_summary(arguments->file));
    };
    return command;
}

Command apply_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command = session_command(
        "apply",
        "change a session as the desktop does: all of the commands, or none",
        R"(show.livery --command '{"set-paint": {"look": 1, "part": "body", "paint": "solid red"}}')",
        arguments,
        {{"--command",
          "JSON...",
          "one command each (see docs/session.md)",
          &arguments->commands,
          true}});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        std::vector<SessionCommand> commands;
        for (const std::string& text : arguments->commands) {
            commands.push_back(parse_session_command(text, "--command"));
        }
        return changed(arguments->file, [&](Session& session) { execute_all(session, commands); });
    };
    return command;
}

Command step_command(bool back) {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command =
        session_command(back ? "undo" : "redo",
                        back ? "take back the last changes" : "do again what was taken back",
                        "show.livery --steps 2",
                        arguments,
                        {{"--steps", "N", "how many (default 1)", &arguments->steps}});
    command.run = [arguments, back](const CommonOptions&, const Progress&) {
        if (arguments->steps < 1) {
            throw std::invalid_argument(
                fmt::format("--steps: found {}, expected 1 or more", arguments->steps));
        }
        return changed(arguments->file,
                       [&](Session& session) { step(session, arguments->steps, back); });
    };
    return command;
}

Command export_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command = session_command("export",
                                      "write a look as a file, its own paints beside it",
                                      "show.livery --look 1 --out look.json",
                                      arguments,
                                      {{"--look", "N", "the look's number", &arguments->look, true},
                                       {"--out", "FILE", "the look file", &arguments->out, true}});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        const Summary summary = read_summary(arguments->file);
        Outcome outcome;
        outcome.figures = {{"files", Json::array()}};
        for (const Path& file : export_look(summary.document, arguments->look, arguments->out)) {
            outcome.figures["files"].push_back(file.string());
            outcome.text += file.string() + "\n";
        }
        return outcome;
    };
    return command;
}

Command export_product_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command =
        session_command("export-product",
                        "write the product as glTF (.glb) that wears all looks, for other programs",
                        "show.livery --look 1 --out car.glb",
                        arguments,
                        {{"--look", "N", "the look that it wears first", &arguments->look, true},
                         {"--out", "FILE", "the mesh, .glb", &arguments->out, true}});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        if (Path(arguments->out).extension() != ".glb") {
            throw std::invalid_argument("--out: found \"" + arguments->out +
                                        "\", expected a name that ends in .glb");
        }
        const Document document = read_summary(arguments->file).document;
        const auto product = find_product(document.product, document.product_unit);
        Outcome outcome;
        const auto notes = export_product(document, product, arguments->look, arguments->out);
        outcome.figures = {{"file", arguments->out}};
        outcome.text = arguments->out + "\n";
        tell_notes(notes, outcome);
        return outcome;
    };
    return command;
}

Command import_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command =
        session_command("import",
                        "add a look from a file",
                        "show.livery --look-file look.json",
                        arguments,
                        {{"--look-file", "FILE", "a look file", &arguments->look_file, true}});
    command.run = [arguments](const CommonOptions&, const Progress&) {
        const Look look = read_look_file(arguments->look_file);
        return changed(arguments->file,
                       [&](Session& session) { execute_all(session, {AddLook{look}}); });
    };
    return command;
}

std::shared_ptr<const ProjectorSetup> setup_of(const Document& document, const Product& product) {
    if (document.calibration.empty()) return uncorrected_setup(document.bench);
    auto setup = load_setup(document.calibration,
                            document.design_white_percentile,
                            product.mesh,
                            document.gamut_mapping);
    if (setup->origin) {
        const std::string other = another_product(*setup->origin, product);
        if (!other.empty()) say("warning: " + other);
    }
    return setup;
}

/// Places seats and says whose eye counts, where that is asked for.
std::vector<SessionCommand> seat_changes(const SessionArguments& arguments,
                                         const Document& document) {
    std::vector<SessionCommand> changes;
    if (arguments.arc != 0) {
        if (arguments.arc < 1 || arguments.arc > static_cast<int>(kMostSeats)) {
            throw std::invalid_argument(
                fmt::format("--arc: found {}, expected 1 to {}", arguments.arc, kMostSeats));
        }
        const auto product = find_product(document.product, document.product_unit);
        changes.emplace_back(SetSeats{
            seats_in_an_arc(bounds_of(product->mesh), eye_in_use_mm(document), arguments.arc)});
    }
    if (!arguments.eye.empty()) {
        changes.emplace_back(UseEye{parse_eye_choice("--eye", arguments.eye)});
    }
    return changes;
}

Command seats_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command = session_command(
        "seats",
        "where people sit, whose eye looks are drawn for, and what the others miss",
        "show.livery --arc 5 --eye mean --look all",
        arguments,
        {{"--arc", "N", "place N seats anew, in an arc before the eye", &arguments->arc},
         {"--eye", "WHOSE", "draw looks for: hand, mean, or a seat's number", &arguments->eye},
         {"--look", "N|all", "tell what each seat misses of it (CIEDE2000)", &arguments->looks},
         {"--maps", "DIR", "with --look: a picture of each", &arguments->maps}});
    command.run = [arguments](const CommonOptions&, const Progress& progress) {
        if (!arguments->maps.empty() && arguments->looks.empty()) {
            throw std::invalid_argument("--maps: found no --look, expected the looks to compare");
        }
        const auto changes = seat_changes(*arguments, read_summary(arguments->file).document);
        if (!changes.empty()) {
            changed(arguments->file, [&](Session& session) { execute_all(session, changes); });
        }
        const Document document = read_summary(arguments->file).document;
        if (arguments->looks.empty()) return seats_told(document);
        const auto product = find_product(document.product, document.product_unit);
        const auto setup = setup_of(document, *product);
        return seats_told(document, arguments->looks, product, *setup, arguments->maps, progress);
    };
    return command;
}

Command picture_command() {
    const auto arguments = std::make_shared<SessionArguments>();
    Command command = session_command(
        "render",
        "draw a look as its projector shows it",
        "show.livery --look 1 --out look.png",
        arguments,
        {{"--look", "N", "the look's number", &arguments->look, true},
         {"--stage",
          "STAGE",
          "radiance, or projector: the corrected input (default radiance)",
          &arguments->stage,
          false,
          {"radiance", "projector"}},
         {"--seat",
          "WHOSE",
          "draw for another eye: hand, mean, or a seat's number (default the session's)",
          &arguments->eye},
         {"--out", "FILE", "the picture, .png or .exr", &arguments->out, true}});
    command.run = [arguments](const CommonOptions& common, const Progress& progress) {
        RenderRequest request;
        request.stage =
            arguments->stage == "projector" ? FrameStage::projector : FrameStage::radiance;
        check_frame_file(arguments->out, request.stage);
        Document document = read_summary(arguments->file).document;
        if (!arguments->eye.empty()) {
            document = applied(document, UseEye{parse_eye_choice("--seat", arguments->eye)});
        }
        if (const auto problems = drawing_problems(document); !problems.empty()) {
            throw Refused(problems.front(), "put the file back, or choose another paint");
        }
        const auto product = find_product(document.product, document.product_unit);
        const auto setup = setup_of(document, *product);
        if (request.stage == FrameStage::projector && !setup->table) {
            throw Refused("the session has no calibration to correct with",
                          "livery session apply --command "
                          "'{\"set-calibration\": {\"folder\": \"DIR\"}}'");
        }
        request.scene = scene_of(document, arguments->look, product);
        request.view = setup->view;
        request.quality = document.quality;
        if (request.quality == Quality::reference) request.backend = RenderBackend::reference;
        if (setup->table) request.compensation = &*setup->table;
        request.gl_device = common.gl_device();
        request.seed = static_cast<std::uint64_t>(common.seed);
        const RenderedFrame frame = render_frame(request, progress);
        write_frame(arguments->out, frame, request.stage);
        Outcome outcome;
        outcome.figures = {
            {"file", arguments->out}, {"ms_total", frame.ms_total}, {"renderer", frame.renderer}};
        outcome.text = arguments->out + "\n";
        return outcome;
    };
    return command;
}

}  // namespace

std::vector<Command> session_commands() {
    return {new_command(),
            show_command(),
            apply_command(),
            step_command(true),
            step_command(false),
            export_command(),
            export_product_command(),
            import_command(),
            picture_command(),
            seats_command()};
}

}  // namespace livery
