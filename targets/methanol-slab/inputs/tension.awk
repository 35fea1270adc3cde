# awk -v edge=13 -v begin=50 -f tension.awk pressures.xvg: surface tension [mN/m] and normal pressure [bar]
# of Pres-XX, Pres-YY, Pres-ZZ of `gmx energy`, both sides of a slab across z, with errors of 20 blocks.
/^[#@]/ || $1 < begin { next }
{
    tension[n] = edge / 20 * ($4 - ($2 + $3) / 2)
    normal[n++] = $4
}
function report(what, v,    k, b, sum, all, squares) {
    for (b = 0; b < 20; b++) {
        sum = 0
        for (k = 0; k < int(n / 20); k++) sum += v[b * int(n / 20) + k]
        sum /= int(n / 20)
        all += sum
        squares += sum * sum
    }
    printf "%s %.2f +- %.2f\n", what, all / 20, sqrt((squares / 20 - (all / 20) ^ 2) / 19)
}
END { report("tension", tension); report("normal", normal) }
