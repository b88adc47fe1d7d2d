// Damaged bytes: a clean error or a session that works, never a crash.

#include <fstream>
#include <iostream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/paths.h"
#include "session/session_file.h"
#include "session/session_script.h"
#include "support/memory_folder.h"
#include "support/temporary_folder.h"
#include "support/thorough.h"

namespace livery {
namespace {

using testing::car;

constexpr int kMutations = 2000;

/// Changes a few bytes, cuts the end off, clears a block or says a piece twice.
std::string mutated(std::string bytes, Random& random) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const std::uint32_t at = random.below(size);
    switch (random.below(8)) {
        case 0:
            bytes.resize(at);
            break;
        case 1:
            for (std::size_t k = at; k < std::min<std::size_t>(size, at + 512); ++k) bytes[k] = 0;
            break;
        case 2:
            bytes.insert(random.below(size), bytes.substr(at, random.below(200)));
            break;
        default:
            // Any byte, or one that is likely at home there.
            for (std::uint32_t k = 0; k <= random.below(4); ++k) {
                bytes[random.below(size)] = random.below(4) == 0
                                                ? static_cast<char>(random.below(256))
                                                : bytes[random.below(size)];
            }
    }
    return bytes;
}

TEST(Mutations, OfCommandsGiveAnErrorOrADocument) {
    const TemporaryFolder folder;
    folder.write("calibration.json", "{}");
    const auto commands = testing::one_of_each(folder.path().string());
    Random random(3);
    int taken = 0;
    for (int k = 0; k < kMutations; ++k) {
        const std::string text = mutated(text_of(testing::pick(random, commands)), random);
        try {
            const SessionCommand command = parse_session_command(text, "mutated");
            label_of(car(), command);
            const std::string after = text_of(applied(car(), command));
            ASSERT_EQ(text_of(parse_document(after, "after")), after) << text;
            ++taken;
        } catch (const FileError&) {
        } catch (const std::invalid_argument&) {
        }
    }
    std::cout << "    seed 3: " << taken << " of " << kMutations << " are still commands\n";
    EXPECT_GT(taken, kMutations / 100);
    EXPECT_LT(taken, kMutations);
}

TEST(Mutations, OfASessionFileGiveAnErrorOrASession) {
    const TemporaryFolder folder(memory_folder());
    const auto file = folder / "whole.livery";
    {
        Session session = Session::open(file);
        for (std::uint64_t step = 0; step < 12; ++step) testing::take_step(session, 4, step);
        session.set_workspace("shown", "1");
    }
    const std::string whole = read_text_file(file);
    Random random(5);
    const int mutations = thorough() ? kMutations : kMutations / 4;
    int opened = 0, wholly = 0;
    for (int k = 0; k < mutations; ++k) {
        // A file of its own: what a broken one leaves beside it is not the next one's.
        const TemporaryFolder own(memory_folder());
        const auto broken = own.write("broken.livery", mutated(whole, random));
        try {
            SessionFile(broken, SessionFile::Access::read).check_all();
            ++wholly;
        } catch (const FileError&) {
        }
        try {
            Session session = Session::open(broken);
            ++opened;
            while (session.can_undo()) session.undo();
            while (session.can_redo()) session.redo();
            session.execute(SetExposure{0.001 * k});
            const std::string text = text_of(session.document());
            ASSERT_EQ(text_of(parse_document(text, "after")), text);
        } catch (const FileError& error) {
            ASSERT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    std::cout << "    seed 5: " << opened << " of " << mutations << " can still be opened, "
              << wholly << " are whole\n";
    EXPECT_GT(opened, 0);
    EXPECT_LT(wholly, mutations);
}

}  // namespace
}  // namespace livery
