# Completion for fish: the program itself lists what can stand at the cursor.
function __toile_complete
    set -l found (toile help complete (commandline --cut-at-cursor | string collect) 2>/dev/null)
    string match --invert -- +files $found
    if contains -- +files $found
        __fish_complete_path (commandline --current-token)
    end
end
complete --command toile --no-files --arguments '(__toile_complete)'
