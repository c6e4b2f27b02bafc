# Makes the man page of a verb from its parts in camber.1: its lines in the synopsis, its entries among the verbs, and
# the options that only it has. Usage: awk -v verb=tiles -v section=Tiles -f verb_man.awk camber.1

BEGIN {
    name["tiles"] = "draw pyramids of map tiles into archives"
    name["serve"] = "serve map tiles over HTTP, drawn on request"
}

function end_block() {
    if (wanted) printf "%s", block
    block = ""
    wanted = 0
}

$1 == ".TH" {
    sub(/CAMBER 1/, "CAMBER-" toupper(verb) " 1")
    print
    print ".SH NAME\ncamber\\-" verb " \\- " name[verb] "\n.SH SYNOPSIS"
    next
}
$1 == ".SH" || $1 == ".SS" {
    end_block()
    part = $2
    if (part == "VERBS") print ".SH DESCRIPTION"
    if (part == section) print ".SH OPTIONS"
    next
}
part == "SYNOPSIS" {
    if (block == "") wanted = $1 == ".B" && $2 == "camber" && $3 == verb
    block = block $0 "\n"
    if ($1 == ".br") end_block()
}
part == "VERBS" {
    if ($1 == ".TP") end_block()
    if (block == ".TP\n") wanted = $1 == ".B" && $2 == verb
    block = block $0 "\n"
}
part == section {
    print
}
END {
    print ".PP\nOptions that other verbs have too, styles, exit statuses, the environment and files are in"
    print ".BR camber (1)."
    print ".SH SEE ALSO\n.BR camber (1),"
    print verb == "tiles" ? ".BR camber\\-serve (1)," : ".BR camber\\-tiles (1),"
    print ".BR camber (3)"
}
