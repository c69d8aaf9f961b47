#!/usr/bin/perl
# Tests of the tests: puts faults into a copy of the sources, one at a time, and
# runs tests until one fails.
#
#   make mutants                        the faults of tests/data/mutants.txt
#   make mutants ARGS=WORD              those of its lines with this word
#   make mutants ARGS=--check           each fault of it stands exactly once
#   make mutants ARGS='--random SEED COUNT [ROOM...]'
#
# A line of the list: FUNCTION @@ OLD @@ NEW @@ by KILLER
#   FUNCTION  a function or a table; FILE.c:FUNCTION, where several files have
#             one of this name
#   OLD       a piece of its text, whole words, however it is spaced, that
#             stands there exactly once: the shortest that does is the best
#   NEW       what stands there instead
#   KILLER    the suite or check that notices it; ?: any one
#
# Random faults stand at any line of the rooms: a wrong sign, index, comparison,
# order of arguments or constant, a statement or a reset that is dropped.  One
# seed draws the same ones as long as the sources stay.  A fault that the
# compiler notices, or that leaves the same machine code, is drawn again.  Only
# the tests that run the line are tried, the quickest first, and after them eight
# of the same with sanitizers; a line that no test runs has a survivor.
# build/coverage keeps which tests run which line.
# Survivors need a reader: some of them change nothing that anybody could notice.
use strict;
use warnings;
use Cwd 'abs_path';
use Digest::MD5 'md5_hex';
use Storable qw(nstore retrieve);
use Time::HiRes 'time';

$| = 1;
delete @ENV{qw(MAKEFLAGS MFLAGS MAKELEVEL)}; # what is made below has its own
my @all_rooms = qw(base model solve step simulation scenes lesson picture play lecture);
my @suites = grep !/check_(?:sources|bench)/, map { m{/(test_\w+)\.c|(check_\w+\.sh)} ? $1 // $2 : () }
             sort glob('tests/unit/*.c tests/checks/*.sh');

sub read_file {
    open(my $file, '<', $_[0]) or die "$_[0]: $!\n";
    local $/;
    return scalar <$file>;
}

# The file keeps its time, so that make does not write listings anew.
sub write_file {
    my ($name, $text) = @_;
    my @times = (stat $name)[8, 9];
    open(my $file, '>', $name) or die "$name: $!\n";
    print $file $text;
    close($file) or die "$name: $!\n";
    utime @times, $name;
}

# ---- faults of the list --------------------------------------------------------
# Returns begin and end of a function or table in a text; or an empty list.
sub definition {
    my ($text, $name) = @_;
    return () if index($text, $name) < 0;
    # A function may be EACH(name), or KERNEL(name, 1).
    my $head = qr/^(?![\s#\/*}])[^;{}=]*?(?<![\w.>])\Q$name\E\b/m;
    return ($-[0], $+[0]) if $text =~ /$head(?:\)?\s*\([^;{]*|, \d+)\)\s*\{.*?\n\}/ms ||
        $text =~ /$head[^;(){}=]*=\s*\{.*?\n\};/ms; # a function, or a table
    return ();
}

# Returns a regular expression for a piece of text with any spacing.
sub piece {
    my ($old) = @_;
    my ($expression, $last) = ('', '');
    for my $token ($old =~ /\w+|[^\w\s]/g) {
        my $apart = $last =~ /\w$/ && $token =~ /^\w/ ? '\s+' : '\s*';
        $expression .= ($last eq '' ? '' : $apart) . quotemeta($token);
        $last = $token;
    }
    $expression = '(?<!\w)' . $expression if $old =~ /^\w/;
    $expression .= '(?!\w)' if $old =~ /\w$/;
    return qr/$expression/;
}

# Returns file, begin and length of a fault; or one text, the reason why not.
sub find_fault {
    my ($function, $old, $sources) = @_;
    my ($file, $name) = $function =~ /^(?:(\S+):)?(\w+)$/;
    my $expression = piece($old);
    my (@found, $defined);
    for my $source (sort keys %$sources) {
        next if $file && $source !~ m{/\Q$file\E$};
        my ($begin, $end) = definition($sources->{$source}, $name);
        next unless defined $begin;
        $defined = 1;
        my $body = substr($sources->{$source}, $begin, $end - $begin);
        push @found, [$source, $begin + $-[0], $+[0] - $-[0]] while $body =~ /$expression/g;
    }
    return "nothing is called $function" unless $defined;
    return "$function has no '$old' any more" unless @found;
    return "$function has '$old' " . @found . ' times' if @found > 1;
    return @{ $found[0] };
}

# Returns the faults of matching lines: file, begin, length, new, text, killer.
sub listed {
    my ($list, $word) = @_;
    my %sources = map { $_ => read_file($_) }
        glob('src/*.[ch] src/*/*.[ch] src/*/*.inc include/*/*.h');
    my ($number, $bad, @faults) = (0, 0);
    for my $line (split(/\n/, read_file($list))) {
        $number++;
        next if $line =~ /^(#.*)?$/ || index($line, $word) < 0;
        my @field = map { s/^\s+|\s+$//gr } split(/ @@(?= |$)/, $line, -1);
        my @where = @field == 4 ? find_fault(@field[0, 1], \%sources) : 'not four fields';
        my $killer = $field[-1] =~ s/^by //r;
        $killer = "test_$killer" if $killer =~ /^\w+$/;
        push @faults, [@where, $field[2], $line, $killer];
        next if @where > 1;
        print "$list:$number: $where[0]: say what it is called now, or delete the line\n";
        $bad = 1;
    }
    exit 1 if $bad;
    return @faults;
}

# ---- random faults ---------------------------------------------------------------
# Replaces comments and strings by blanks of the same length.
sub mask {
    my ($text) = @_;
    $text =~ s{(/\*.*?\*/|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')}
              {my ($part, $blank) = ($1, substr($1, 0, 1) eq '/' ? ' ' : "\x01");
               $part =~ s/[^\n]/$blank/gr}gse;
    return $text;
}

my %other = ('<' => '<=', '<=' => '<', '>' => '>=', '>=' => '>', '==' => '!=',
             '!=' => '==', '&&' => '||', '||' => '&&', '+' => '-', '-' => '+',
             '+=' => '-=', '-=' => '+=');
my $simple = qr/[\w.\[\]&*]+(?:->[\w.\[\]]+)*/;

# Returns possible faults of a masked line: kind, column, length, new text.
sub faults_of {
    my ($line, $whole) = @_;
    my @found;
    my $add = sub { push @found, [$_[0], $-[1], $+[1] - $-[1], $_[1]] };
    my $declares = $line =~
        /^\s+(?:static |const |struct |unsigned )*\w+ \**\w+(?:\[[^\]]*\])+(?:[;,]| =)/;
    $add->('sign', $other{$1}) while $line =~ /(?<=[\w)\]]) ([-+]=?) (?=[\w(&*])/g;
    $add->('sign', '') while $line =~ /(?:[=(,?:*\/] ?|return )(-)(?=[A-Za-z_(])/g;
    $add->('comparison', $other{$1}) while $line =~ / (<=?|>=?|==|!=|&&|\|\|)(?: |$)/g;
    while (!$declares && $line =~ /(?<=[\w\])])\[([^\[\]]+)\]/g) {
        my ($old, $column) = ($1, 0 + $-[1]);
        push @found, ['index', $column, length $old,
            $old eq '0' ? 1 : $old =~ /^(.*) [-+] 1$/ ? $1 : "$old + 1"];
    }
    while ($line =~ /[(,] ?($simple, $simple)(?=[,)])/g) {
        my ($first, $second) = split(/, /, $1);
        $add->('order', "$second, $first") if $first ne $second;
        pos($line) = $+[1] - length $second;
    }
    $add->('constant', $1 eq '0' ? 1 : $1 eq '1' ? 2 : "($1 * 1.5)")
        while !$declares && $line =~ /(?<![\w.'])(\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.])/g;
    return @found unless $whole &&
        $line =~ /^\s++((?!return|break|continue|goto|case|default|static|const|else)[^;{}]+;)\s*$/;
    my ($statement, $column) = ($1, 0 + $-[1]);
    my $kind = $statement =~ / = (?:0|false|NULL|-1);|^memset/ ? 'reset' : 'dropped';
    push @found, [$kind, $column, length $statement, ';']
        if $line !~ /^\s++(?:unsigned |struct )?\w+ \**\w+(?:\[.*\])?(?:;| = |, )/;
    return @found;
}

# Returns the lines that can have a fault: file, number, begin, faults.
sub lines_of {
    my ($text, @rooms) = @_;
    my @lines;
    for my $file (map { $_ eq 'lecture' ? 'src/lecture.c' : sort glob("src/$_/*.c") } @rooms) {
        next if $file =~ /_web\.c$/;
        my $masked = mask($text->{$file} = read_file($file));
        my ($number, $at, $inside, $before) = (0, 0, 0, '');
        for my $line (split /\n/, $masked) {
            $number++;
            $inside = 1 if $line =~ /^(\{|.*= \{$)/;
            my @faults = $inside && $line =~ /^ {4}/
                ? faults_of($line, $before =~ /[;{})]\s*$|^\s*$|:\s*$/) : ();
            push @lines, [$file, $number, $at, \@faults] if @faults;
            $inside = 0 if $line =~ /^\}/;
            $before = $line if $line =~ /\S/;
            $at += length($line) + 1;
        }
    }
    return @lines;
}

# The folder in which make builds the tests now, and how it is called.
our ($folder, $make) = ('build/release', 'make -s');

# ---- what each test runs -------------------------------------------------------------
# Runs a check, a suite, or one test of a suite ("SUITE NAME"); returns true if
# it passed.
sub passes {
    my ($test, $settings) = @_;
    my ($suite, $name) = split(/ /, $test, 2);
    my $run = $suite =~ /\.sh$/ ? "sh tests/checks/$suite" : "$folder/tests/unit/$suite";
    $run .= " '" . $name =~ s/'/'\\''/gr . "'" if defined $name;
    return system("ulimit -c 0; $settings " .
        "exec timeout -k 5 3600 $run >log 2>&1 </dev/null") == 0;
}

# Builds the suites, or the programs that checks start.
sub build {
    my ($settings, @tests) = @_;
    my %suites = map { s/ .*//r => 1 } grep !/^check/, @tests;
    my @programs = grep(/^check|widths/, @tests) ? qw(build/elasto build/lecture) : ();
    return system("$make $settings " . join(' ', @programs,
        map { "$folder/tests/unit/$_" } sort keys %suites) . ' >log 2>&1') == 0;
}

# The checks, the suites, and the single tests of slow suites, with their run times
# in s.  $runs{FILE}[LINE]: a bit for each of them, 1 if it runs this line; undef:
# the compiler has made no code of this line alone.
my (@tests, @seconds, %runs);

# Runs a test in the coverage tree, and stores the lines that it ran. Returns
# the names of its parts.
sub count_lines {
    my ($test) = @_;
    my $begin = time;
    passes($test, '') || $test !~ / / or print "$test: fails alone\n";
    push @tests, $test;
    push @seconds, time() - $begin;
    my @parts = read_file('log') =~ /^\[ RUN      \] (.*)$/mg;
    my $file = '';
    for (split(/\n/, `find build -name '*.gcda' | xargs gcov -t 2>/dev/null`)) {
        $file = $1 if /^ *-: +0:Source:(.*)/;
        next unless $file =~ /^src/ && /^ *(\d+|#####)\*?: *(\d+):/;
        $runs{$file}[$2] //= '';
        vec($runs{$file}[$2], $#tests, 1) |= $1 ne '#####'; # of several functions
    }
    system(q(find build -name '*.gcda' -delete));
    return @parts;
}

# Builds a coverage tree and runs all tests there; or reads the stored coverage
# of the same sources.
sub load_counts {
    my $sources = md5_hex(map { read_file($_) } grep /\.(?:[ch]|inc|def|awk|sh|txt)$/,
                          sort(glob('src/* src/*/* include/*/* tests/*/*')));
    my $kept = eval { retrieve('../coverage') };
    if (!$kept || $kept->[0] ne $sources) {
        print "counting which test runs which line\n";
        system('mkdir -p counted/build && cp -pR Makefile README.md include src tests counted && ' .
               'cp -p build/*.mk counted/build') == 0 or die;
        chdir 'counted' or die;
        build("CFLAGS='-Og -g --coverage'", @suites) or die read_file('log');
        for my $suite (@suites) {
            my @parts = count_lines($suite);
            next unless @parts && $seconds[-1] > 2;
            $seconds[-1] = 1e9; # its tests run one by one instead
            count_lines("$suite $_") for @parts;
        }
        chdir '..';
        $kept = [$sources, \@tests, \@seconds, \%runs];
        nstore($kept, '../coverage');
    }
    @tests = @{ $kept->[1] };
    @seconds = @{ $kept->[2] };
    %runs = %{ $kept->[3] };
}

# Returns the tests that run a line of a file, or all tests for tables outside
# of functions. Checks that compile lecture.c themselves are not counted.
sub tests_of {
    my ($file, $number, $text) = @_;
    my @lines = ('', split(/\n/, $text));
    $number-- until defined $runs{$file}[$number] || $lines[$number] =~ /^[}\w]/ || !$number;
    my $bits = $runs{$file}[$number];
    my @found = grep { $seconds[$_] < 1e9 && (!defined $bits || vec($bits, $_, 1)) } 0 .. $#tests;
    return ((map { $tests[$_] } sort { $seconds[$a] <=> $seconds[$b] } @found),
            $file eq 'src/lecture.c' ? qw(check_lecture.sh check_homework.sh) : ());
}

# ---- one fault after the other -----------------------------------------------------
# Returns the first test that fails, or nothing. A check may fail by chance
# once.
our $quick = 'ulimit -S -t 60; CMOCKA_TEST_ABORT=1';
sub killer {
    my %built;
    for my $test (@_) {
        build('', $test) or return 'make' unless $built{$test =~ s/ .*//r}++;
        passes($test, $quick) || ($test =~ /\.sh$/ && passes($test, $quick)) or return $test;
    }
    return '';
}

my %right; # tests that found a fault, and pass without it

# Returns the killer of a fault, '' for none; undef: the code is unchanged.
sub try_fault {
    my ($file, $begin, $length, $new, @tests) = @_;
    my ($object) = $file =~ m{^src/(.*)\.c$} ? "$folder/$1.o" : 'none';
    my @again = $object =~ s{/\w+/(?=\w+\.o)}{/narrow/}r; # suites link this object, too
    @again = glob("$folder/tests/unit/test_reference{,.o}") if $file eq 'src/lecture.c';
    my $text = read_file($file);
    my $wrong = $text;
    substr($wrong, $begin, $length) = $new;
    rename $object, 'object';
    write_file($file, $wrong);
    unlink @again;
    utime undef, undef, $file if $object eq 'none'; # others include it
    my $fault = $object eq 'none' || (system("$make $object >log 2>&1") == 0 &&
        read_file('log') !~ /warning:/ &&
        system("strip -g -o a object && strip -g -o b $object && cmp -s a b") != 0);
    my $found = $fault ? killer(@tests) : undef;
    write_file($file, $text);
    utime undef, undef, $file if $object eq 'none';
    unlink @again;
    rename 'object', $object;
    utime undef, undef, $object; # what was linked with the fault is older
    unlink "$folder/libelasto.a", "$folder/lecture";
    if ($found && $found ne 'make' && !$right{"$folder $found"}++) {
        build('', $found) && passes($found, $quick) or die "$found fails without a fault\n", `tail -n 20 log`;
    }
    return $found;
}

# Returns the killer of a fault among the eight quickest tests, with sanitizers.
sub try_with_sanitizers {
    my ($fault, @tests) = @_;
    local ($folder, $make, $quick) = ('build/sanitize-address-undefined',
        'make -s SANITIZE=address,undefined', 'ulimit -S -t 600; CMOCKA_TEST_ABORT=1');
    -e $folder or build('', grep !/^check/, @suites) or die read_file('log');
    @tests = grep !/^check/, @tests;
    my $found = try_fault(@$fault, @tests > 8 ? @tests[0 .. 7] : @tests);
    return $found ? "$found with sanitizers" : '';
}

my ($how, $seed, $count, @rooms) = @ARGV ? @ARGV : '';
my @faults = $how eq '--random' ? () : listed('tests/data/mutants.txt', $how =~ s/^(?:--)?check$//r);
exit 0 if $how =~ /^(?:--)?check$/;
die "no fault contains '$how'\n" unless @faults || $how eq '--random';

my $tree = abs_path('.') . "/build/mutants.$$";
mkdir $tree or die "$tree: $!\n";
END { system('rm', '-rf', $tree) if $tree }
$SIG{INT} = $SIG{TERM} = $SIG{HUP} = sub { exit 1 };
setpriority(0, 0, 15);
system("mkdir $tree/build; cp -pR Makefile README.md include src tests $tree && " .
       "cp -pR build/*.mk build/release $tree/build") == 0 or die;
chdir $tree or die;
my (%drawn, %killed, @survivors);
sub report {
    my ($file, $killer, $text) = @_;
    my $room = $file =~ m{/(\w+)/} ? $1 : 'lecture';
    $drawn{$room}++;
    $killed{$room} += $killer ne '';
    push @survivors, $text if $killer eq '';
    print $killer eq '' ? "SURVIVED: $text\n" : "killed by $killer: $text\n";
}
for my $fault (@faults) {
    my ($file, $begin, $length, $new, $text, $killer) = @$fault;
    report($file, try_fault($file, $begin, $length, $new, $killer) // '', $text);
}
if ($how eq '--random') {
    my %text;
    load_counts();
    my @lines = lines_of(\%text, @rooms ? @rooms : sort @all_rooms);
    srand($seed);
    while ($count > 0) {
        my ($file, $number, $at, $kinds) = @{ $lines[rand @lines] };
        my ($kind, $column, $length, $new) = @{ $kinds->[rand @$kinds] };
        my @fault = ($file, $at + $column, $length, $new);
        my @tests = tests_of($file, $number, $text{$file});
        my $killer = try_fault(@fault, @tests) // next;
        $killer = try_with_sanitizers(\@fault, @tests) if $killer eq '';
        my $old = substr($text{$file}, $at + $column, $length);
        report($file, $killer, "$file:$number $kind: $old -> $new");
        $count--;
    }
}
my ($all, $dead) = (0, 0);
for my $room (sort keys %drawn) {
    printf "%-8s %3d of %3d, %3.0f %%\n", $room, $killed{$room}, $drawn{$room},
        100 * $killed{$room} / $drawn{$room};
    $all += $drawn{$room};
    $dead += $killed{$room};
}
printf "all      %3d of %3d, %3.0f %%\n", $dead, $all, 100 * $dead / $all;
print map { "survived: $_\n" } @survivors;
exit(@survivors && $how ne '--random');
