#compdef shadowbench
# Completion for bash, and for zsh through its bashcompinit. What there is, the program's own help says.
_shadowbench_words() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]} named='' help about offered i
  [[ $word == '=' ]] && word=''
  [[ $before == '=' ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  for ((i = 1; i < COMP_CWORD; ++i)); do
    [[ ${COMP_WORDS[i]} == -* ]] && break
    named+=" ${COMP_WORDS[i]}"
  done
  help=$("$program" $named --help-all 2>/dev/null)
  [[ $before == --* ]] && about=$(sed -n "s/^  $before \([^ ]*\).*/\1/p" <<<"$help")
  case $word:$about in
    -*) offered=$(grep -oE '^  -[^ ]*' <<<"$help" | tr , ' ') ;;
    *:SCENE*) offered=$("$program" list scenes | sed 's/ .*//') ;;
    *:FILTERS*) offered="all $("$program" list filters | sed -n 's/^\([^ ][^ ]*\) .*/\1/p')" ;;
    *'|'*) offered=${about//|/ } ;;
    *:) offered=$(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' <<<"$help") ;;
  esac
  COMPREPLY=($(compgen -P "${word%"${word##*,}"}" -W "$offered" -- "${word##*,}"))
}
[[ -z $ZSH_VERSION ]] || { autoload -Uz bashcompinit && bashcompinit; }
complete -o bashdefault -o default -F _shadowbench_words shadowbench
[[ -z $ZSH_VERSION || -z $compstate ]] || _bash_complete -o default -F _shadowbench_words
