# Completion for bash: the program itself lists what can stand at the cursor.
_toile() {
  local line=${COMP_LINE:0:COMP_POINT} begun found word keep=
  begun=${line##*[[:space:]]}
  # Readline replaces only what follows the last = or : of the word.
  if [[ $begun == *[=:]* && $COMP_WORDBREAKS == *=* ]]; then keep=${begun%"${begun##*[=:]}"}; fi
  COMPREPLY=()
  while IFS=$'\t' read -r word _; do
    if [[ $word == +files ]]; then
      while IFS= read -r found; do COMPREPLY+=("$found"); done < <(compgen -f -- "${begun#"$keep"}")
      compopt -o filenames 2>/dev/null
    else
      COMPREPLY+=("${word#"$keep"}")
    fi
  done < <(toile help complete "$line" 2>/dev/null)
  if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2>/dev/null; fi
}
complete -F _toile toile
