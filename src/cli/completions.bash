
# Options are offered once a dash is typed; before that the shell offers files where a file is meant.
_tilebind_without_options() {
    _tilebind "$@"
    if [[ $2 != -* ]]; then
        local candidate kept=()
        for candidate in "${COMPREPLY[@]}"; do
            [[ $candidate == -* ]] || kept+=("$candidate")
        done
        COMPREPLY=("${kept[@]}")
    fi
}

complete -F _tilebind_without_options -o bashdefault -o default tilebind
