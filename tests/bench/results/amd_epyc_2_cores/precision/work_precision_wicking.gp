set terminal pngcairo size 640,560 font 'DejaVu Sans,11'
set output 'work_precision_wicking.png'
set border 3 lw 1
set tics nomirror out scale 0.6
set grid lc rgb '#e4e4e4' lw 1
set logscale xy
set format '10^{%T}'
set bmargin 9
set key at screen 0.5,0.03 center bottom vertical maxrows 5 samplen 2.5 font ',9'
set xlabel 'run time [s]'
set ylabel 'relative error'
$front_0_0 << EOD
0.111611 0.00965431
1.10008 0.00950515
4.08086 0.00917721
9.86101 0.0091131
EOD
$published_0_0 << EOD
11.6371 0.0289269
9.86101 0.0091131
10.6614 0.0200765
14.6119 0.0403629
EOD
$all_0_0 << EOD
11.6371 0.0289269
4.82554 0.0289731
1.28559 0.0262117
0.508909 0.0221306
0.140176 0.0119077
9.86101 0.0091131
4.08086 0.00917721
1.10008 0.00950515
0.454446 0.0101851
0.111611 0.00965431
10.6614 0.0200765
4.27253 0.0201248
1.13842 0.0203644
0.464258 0.0189248
0.120688 0.0115968
14.6119 0.0403629
6.10199 0.0401897
1.60064 0.0414859
0.695382 0.0345386
0.227681 0.0176972
EOD
$best_0_0 << EOD
0.111611 0.00965431
1.10008 0.00950515
4.08086 0.00917721
9.86101 0.0091131
EOD
set title 'Wicking in a yarn' noenhanced
plot $front_0_0 with lines lw 9 lc rgb '#d0d0d0' title 'best of all', \
  $all_0_0 with points pt 7 ps 0.5 lc rgb '#000000' notitle, \
  $best_0_0 with lines lw 1.6 lc rgb '#000000' dt 1 title '-' noenhanced, \
  $published_0_0 with points pt 6 ps 2.4 lw 2 lc rgb '#000000' title 'published scheme'
