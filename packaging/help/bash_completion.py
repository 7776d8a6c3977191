"""A completion for bash from a program's help. It needs bash alone, not the package bash-completion, which loads it."""

from completion_values import values

HEAD = """# bash completion for {name}, made from its --help
{function}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
  # --option=value is three words here.
  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  COMPREPLY=()
"""
TAIL = """}}
complete -o filenames -F {function} {name}
"""


def function_name(name):
    return "_" + name.replace("-", "_")


def propose(value):
    """Commands that fill COMPREPLY."""
    if value.kind == "words":
        return [f'mapfile -t COMPREPLY < <(compgen -W "{" ".join(value.words)}" -- "$word")']
    if value.kind == "folders":
        return ['mapfile -t COMPREPLY < <(compgen -d -- "$word")']
    if value.kind == "files" and value.pattern:
        return [f"mapfile -t COMPREPLY < <(compgen -d -- \"$word\"; shopt -s extglob; compgen -f -X '!*.@({value.pattern})' -- \"$word\")"]
    if value.kind == "files":
        return ['mapfile -t COMPREPLY < <(compgen -f -- "$word")']
    return [":"]


def options_of(help_, indent):
    """Completes the options of a program or a verb, their values, and its positionals."""
    takers = [option for option in help_.options if option.takes]
    lines = []
    if takers:
        lines.append("case $before in")
        for option in takers:
            lines += [f"  {'|'.join(option.names)})", *("    " + line for line in propose(values(option))), "    return ;;"]
        lines.append("esac")
    names = [name for option in help_.options for name in option.names if name.startswith("--")]
    lines += ["if [[ $word == -* ]]; then", f'  mapfile -t COMPREPLY < <(compgen -W "{" ".join(names)}" -- "$word")', "  return", "fi"]
    words = help_.verbs_as_words()
    if words:
        lines += ["if ((COMP_CWORD == 1)); then", f'  mapfile -t COMPREPLY < <(compgen -W "{" ".join(words)}" -- "$word")', "fi",
                  "[[ -n $word && ${#COMPREPLY[@]} -gt 0 ]] && return", 'local proposed=("${COMPREPLY[@]}")']
    if help_.positionals:
        lines += propose(values(help_.positionals[0]))
    if words:
        lines.append('COMPREPLY=("${proposed[@]}" "${COMPREPLY[@]}")')
    return [" " * indent + line for line in lines]


def bash_completion(help_):
    form = {"name": help_.command, "function": function_name(help_.command)}
    lines = []
    if help_.verbs:
        lines += ["  local verb= i", "  for ((i = 1; i < COMP_CWORD; ++i)); do", "    case ${COMP_WORDS[i]} in",
                  f"      {'|'.join(verb.names[0] for verb in help_.verbs)}) verb=${{COMP_WORDS[i]}}; break ;;", "    esac", "  done",
                  "  case $verb in"]
        for each in help_.verb_helps:
            lines += [f"    {each.command.split()[-1]})", *options_of(each, 6), "      return ;;"]
        names = [name for option in help_.options for name in option.names if name.startswith("--")]
        verbs = [verb.names[0] for verb in help_.verbs]
        lines += ["  esac", f'  mapfile -t COMPREPLY < <(compgen -W "{" ".join(verbs + names)}" -- "$word")']
    else:
        lines += options_of(help_, 2)
    return HEAD.format(**form) + "\n".join(lines) + "\n" + TAIL.format(**form)
