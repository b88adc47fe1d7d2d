// A vote in the running window: freezing looks, and what the projector shows of them.
#pragma once

namespace livery {

struct KeyChord;
struct Shell;

/// Once a frame of the window, before it is drawn: takes over what the panel asked for, goes on
/// freezing, lets time go by and puts on the projector what is to be seen.
void step_vote_mode(Shell& shell);

/// What a key means while looks are presented, presenters' remote controls among them; false: it
/// means what it always does. A key that is held down counts once.
bool vote_mode_key(Shell& shell, const KeyChord& chord, bool repeated);

/// When the window must look again; 0: something else will wake it.
double next_vote_change_s(const Shell& shell);

/// The bar over the whole width, which nobody can miss, and what the audience sees.
bool has_vote_bar(const Shell& shell);
/// Whether the program may end now. While a round is under way it has to be asked twice within some
/// seconds; the first time says what ends.
bool may_quit(Shell& shell);

void draw_vote_bar(Shell& shell);
void draw_vote_stage(Shell& shell);

}  // namespace livery
