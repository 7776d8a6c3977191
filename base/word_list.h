// Words and lines of text: lists of words for a message, and the known word that a misspelt one may mean.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// The lines without their ends; a line end at the end of the text begins no further line.
std::vector<std::string> TextLines(const std::string& text);

// The text without blanks, tabs and carriage returns at both ends.
std::string Trimmed(const std::string& text);

// The text as one word for sh, in quotes where it needs them.
std::string ShellWord(const std::string& text);

// Joins lists of words for a sentence.

// "a, b, c"
std::string Joined(const std::vector<std::string>& parts, const std::string& between = ", ");
// "a, b and c"
std::string Enumerated(const std::vector<std::string>& parts);
// "run sine"; a name that already begins with "run" stays the same: "run 5"
std::string RunNamed(const std::string& name);
// "run a"; "runs a and b"; "run 5 and run 6"
std::string RunsNamed(const std::vector<std::string>& names);
// The same, or "every run" where `names` has all of several, of which there are `runs`.
std::string RunsNamed(const std::vector<std::string>& names, size_t runs);

// Finds the name that a misspelling probably meant.

// The entry of `names` nearest to `found` in single-character edits, or empty when none is close.
std::string Nearest(const std::string& found, const std::vector<std::string>& names);

// ", did you mean \"x\"?", or empty.
std::string DidYouMean(const std::string& found, const std::vector<std::string>& names);

}  // namespace hydro
