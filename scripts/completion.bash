# bash completion of `billiard`, by its own tables (`billiard help --complete`).
_billiard()
{
	local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words=
	if [ "$COMP_CWORD" -eq 1 ]; then
		words=$("${COMP_WORDS[0]}" help --complete 2>/dev/null)
	elif [ "$command" = help ]; then
		words="--man $("${COMP_WORDS[0]}" help --complete 2>/dev/null)"
	elif [[ $before == --* ]]; then
		words=$("${COMP_WORDS[0]}" help --complete "$command" "$before" 2>/dev/null)
	fi
	# Options where one begins; the names of a first operand; else files.
	[ -n "$words" ] || words=$("${COMP_WORDS[0]}" help --complete "$command" 2>/dev/null)
	[[ $cur == -* ]] || words=$(grep -v '^-' <<<"$words")
	mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
	[ "${#COMPREPLY[@]}" -gt 0 ] || mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}
complete -o filenames -F _billiard billiard
