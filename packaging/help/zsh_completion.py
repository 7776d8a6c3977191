"""A completion for zsh from a program's help."""

from completion_values import values


def quoted(text):
    """Within _arguments' '...[...]'."""
    for character in "\\[]:":
        text = text.replace(character, "\\" + character)
    return text.replace("'", "'\\''")


def action(value):
    if value.kind == "words":
        return f"({' '.join(value.words)})"
    if value.kind == "folders":
        return "_files -/"
    if value.kind == "files" and value.pattern:
        # Brackets around one word would be a glob's qualifiers.
        return f'_files -g "*.({value.pattern})"' if "|" in value.pattern else f'_files -g "*.{value.pattern}"'
    return "_files" if value.kind == "files" else " "


def option_spec(option):
    """One specification of _arguments."""
    takes = f":{quoted(option.takes)}:{action(values(option))}" if option.takes else ""
    means = f"[{quoted(option.means)}]{takes}"
    if option.repeated:
        return " ".join(f"'*{name}{means}'" for name in option.names)
    if len(option.names) == 1:
        return f"'{option.names[0]}{means}'"
    return f"'({' '.join(option.names)})'{{{','.join(option.names)}}}'{means}'"


def positional_spec(positional, place):
    place = "*" if positional.repeated else str(place)
    return f"'{place}:{quoted(positional.names[0])}:{action(values(positional))}'"


def specs(help_):
    found = [option_spec(option) for option in help_.options]
    words = help_.verbs_as_words()
    if words:
        first = help_.positionals[0]
        return [*found, f"'1:verb or {quoted(first.names[0])}: _alternative \"verbs:verb:({' '.join(words)})\" \"files:file:_files\"'",
                f"'2:{quoted(first.names[0])}:{action(values(first))}'"]
    return found + [positional_spec(each, place) for place, each in enumerate(help_.positionals, 1)]


def arguments(help_, indent, *flags):
    return (" \\\n" + " " * (indent + 2)).join([" " * indent + " ".join(["_arguments", *flags]), *specs(help_)])


def zsh_completion(help_):
    head = f"#compdef {help_.command}\n# made from its --help\n"
    if not help_.verbs:
        return head + arguments(help_, 0) + "\n"
    verbs = [f"{verb.names[0]}:{verb.means}".replace("'", "'\\''") for verb in help_.verbs]
    lines = ["local -a verbs=(" + " ".join(f"'{verb}'" for verb in verbs) + ")", "local curcontext=$curcontext state line",
             "_arguments -C \\", *(f"  {option_spec(option)} \\" for option in help_.options),
             "  '1:verb:->verb' '*::argument:->argument' && return", "case $state in", "  verb) _describe verb verbs ;;",
             "  argument)", "    case $line[1] in"]
    for each in help_.verb_helps:
        lines += [f"      {each.command.split()[-1]})", arguments(each, 8), "        ;;"]
    return head + "\n".join([*lines, "    esac ;;", "esac"]) + "\n"
